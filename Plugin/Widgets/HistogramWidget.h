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
 * How many voxels have which value, as bars, with a line at one value that the mouse drags and a
 * dotted one at Otsu's threshold. Heights are logarithmic: background is most of a volume.
 */
class HistogramWidget : public QWidget
{
public:
  explicit HistogramWidget(QWidget* parent);
  ~HistogramWidget() override;

  /** Of bins of the same width between two values; NaN: there is no threshold. */
  void SetCounts(double low, double high, const std::vector<double>& counts, double threshold);
  /** Where the line is. */
  void SetValue(double value);
  /** Where the values that are chosen end, from the line on; NaN: nothing shows that. */
  void SetUpper(double value);

  /** Called while the line is dragged, at last with true. */
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
