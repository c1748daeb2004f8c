// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "HistogramWidget.h"

#include <QMouseEvent>
#include <QPainter>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numeric>

namespace volumic
{
namespace
{
constexpr int Height = 56;

/** Return the heights of bars: at most `most`, or fewer if integers leave bins empty. */
std::vector<double> BarsOf(const std::vector<double>& counts, int most)
{
  const auto bins = static_cast<int>(counts.size());
  std::vector<double> bars;
  for (int number = std::min(most, bins); number > 8; number /= 2)
  {
    bars.assign(static_cast<std::size_t>(number), 0.0);
    for (int bar = 0; bar < number; ++bar)
    {
      const auto first = counts.begin() + bar * bins / number,
                 end = counts.begin() + (bar + 1) * bins / number;
      bars[static_cast<std::size_t>(bar)] = std::log1p(std::accumulate(first, end, 0.0));
    }
    if (2 * std::count(bars.begin(), bars.end(), 0.0) < number)
    {
      break;
    }
  }
  return bars;
}
}

//------------------------------------------------------------------------------
HistogramWidget::HistogramWidget(QWidget* parent) : QWidget(parent)
{
  this->setObjectName("Histogram");
  this->setSizePolicy(QSizePolicy::Ignored, QSizePolicy::Fixed);
  this->setCursor(Qt::SizeHorCursor);
}

HistogramWidget::~HistogramWidget() = default;

//------------------------------------------------------------------------------
QSize HistogramWidget::sizeHint() const
{
  return { 200, Height };
}

QSize HistogramWidget::minimumSizeHint() const
{
  return { 40, Height };
}

//------------------------------------------------------------------------------
void HistogramWidget::SetCounts(
  double low, double high, const std::vector<double>& counts, double threshold)
{
  this->Low = low;
  this->High = high;
  this->Counts = counts;
  this->Threshold = threshold;
  this->setToolTip(tr("Number of voxels of each value, from %1 to %2 (logarithmic). Drag the line "
                      "to set Iso Value. The dotted line is Otsu's threshold, %3.")
                     .arg(low)
                     .arg(high)
                     .arg(threshold));
  this->update();
}

void HistogramWidget::SetValue(double value)
{
  this->Value = value;
  this->update();
}

void HistogramWidget::SetUpper(double value)
{
  this->Upper = value;
  this->update();
}

//------------------------------------------------------------------------------
int HistogramWidget::ColumnOf(double value) const
{
  const double share = (value - this->Low) / (this->High - this->Low);
  return static_cast<int>(std::lround(std::clamp(share, 0.0, 1.0) * (this->width() - 1)));
}

//------------------------------------------------------------------------------
void HistogramWidget::paintEvent(QPaintEvent*)
{
  QPainter painter(this);
  const QPalette& colors = this->palette();
  painter.fillRect(this->rect(), colors.color(QPalette::Base));
  const std::vector<double> bars = BarsOf(this->Counts, this->width());
  if (bars.empty())
  {
    return;
  }
  const double most = *std::max_element(bars.begin(), bars.end());
  const auto count = static_cast<int>(bars.size());
  const int below = this->height();
  for (int bar = 0; bar < count; ++bar)
  {
    const int left = bar * this->width() / count, right = (bar + 1) * this->width() / count;
    const auto high =
      static_cast<int>(std::lround(bars[static_cast<std::size_t>(bar)] / most * (below - 4)));
    painter.fillRect(left, below - high, right - left, high, colors.color(QPalette::Mid));
  }
  if (!std::isnan(this->Threshold))
  {
    painter.setPen(QPen(colors.color(QPalette::Text), 1, Qt::DotLine));
    const int column = this->ColumnOf(this->Threshold);
    painter.drawLine(column, 0, column, below);
  }
  const int column = this->ColumnOf(this->Value);
  if (this->Upper > this->Value)
  {
    const int end = this->ColumnOf(this->Upper);
    painter.fillRect(column, 0, end - column, below, QColor(208, 32, 32, 64));
  }
  painter.fillRect(column - 1, 0, 2, below, QColor(208, 32, 32));
}

//------------------------------------------------------------------------------
void HistogramWidget::Drag(const QMouseEvent* event, bool isDone)
{
  // On release, buttons() lacks the button that is released.
  const bool isLeft = (event->buttons() | event->button()).testFlag(Qt::LeftButton);
  if (!isLeft || this->Counts.empty() || this->width() < 2)
  {
    return;
  }
  const double share = std::clamp(event->pos().x() / (this->width() - 1.0), 0.0, 1.0);
  const double step = (this->High - this->Low) / this->width();
  const double round = std::pow(10.0, std::floor(std::log10(step)));
  const double value = std::round((this->Low + share * (this->High - this->Low)) / round) * round;
  this->Value = std::clamp(value, this->Low, this->High);
  this->update();
  if (this->Dragged)
  {
    this->Dragged(this->Value, isDone);
  }
}

void HistogramWidget::mousePressEvent(QMouseEvent* event)
{
  this->Drag(event, false);
}

void HistogramWidget::mouseMoveEvent(QMouseEvent* event)
{
  this->Drag(event, false);
}

void HistogramWidget::mouseReleaseEvent(QMouseEvent* event)
{
  this->Drag(event, true);
}
}
