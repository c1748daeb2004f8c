// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicHistogramWidget_h
#define volumicHistogramWidget_h

#include <QWidget>

#include <functional>
#include <limits>
#include <vector>

namespace volumic
{
/**
 * Histogram of voxels with a line that the mouse drags. A dotted line marks Otsu's threshold.
 * Heights are logarithmic, because most voxels are background.
 */
class HistogramWidget : public QWidget
{
public:
  explicit HistogramWidget(QWidget* parent);
  ~HistogramWidget() override;

  /** Set the counts of bins of equal width between two values. A threshold of NaN is not shown. */
  void SetCounts(double low, double high, const std::vector<double>& counts, double threshold);
  /** Set the position of the line. */
  void SetValue(double value);
  /** Set the upper end of the chosen values, which begin at the line (NaN: none). */
  void SetUpper(double value);

  /** Called while the line is dragged; isDone is true for the last call. */
  std::function<void(double value, bool isDone)> Dragged;

  QSize sizeHint() const override;
  QSize minimumSizeHint() const override;

protected:
  void paintEvent(QPaintEvent* event) override;
  void mousePressEvent(QMouseEvent* event) override;
  void mouseMoveEvent(QMouseEvent* event) override;
  void mouseReleaseEvent(QMouseEvent* event) override;

private:
  int ColumnOf(double value) const;
  void Drag(const QMouseEvent* event, bool isDone);

  double Low = 0.0;
  double High = 0.0;
  double Threshold = 0.0;
  double Value = 0.0;
  double Upper = std::numeric_limits<double>::quiet_NaN();
  std::vector<double> Counts;
};
}

#endif
