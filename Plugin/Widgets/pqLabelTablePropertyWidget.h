// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef pqLabelTablePropertyWidget_h
#define pqLabelTablePropertyWidget_h

#include <pqPropertyWidget.h>

#include <QList>
#include <QVariant>

#include <memory>

class QTreeWidgetItem;

/**
 * A table of the labels of the input, for a property that lists some of them and, empty, means all
 * but the one that the property BackgroundLabel holds: name and colour, value, number of voxels,
 * each with a box to check. A click on a title sorts; what is typed above the table leaves the rows
 * that contain it, on which All and None act. The box of one of several selected rows checks all of
 * them.
 *
 *   <IntVectorProperty panel_widget="LabelTable" ...>
 *     <LabelsDomain .../>  <!-- tells the labels -->
 */
class pqLabelTablePropertyWidget : public pqPropertyWidget
{
  Q_OBJECT
  Q_PROPERTY(QList<QVariant> labels READ labels WRITE setLabels)
  using Superclass = pqPropertyWidget;

public:
  pqLabelTablePropertyWidget(
    vtkSMProxy* proxy, vtkSMProperty* property, QWidget* parent = nullptr);
  ~pqLabelTablePropertyWidget() override;

  QList<QVariant> labels() const;
  void setLabels(const QList<QVariant>& labels);

Q_SIGNALS:
  void labelsChanged();

private Q_SLOTS:
  /** Lists the labels of the input as it is now. */
  void fillTable();
  /** Checks what the property lists. */
  void checkRows();
  void filterRows(const QString& text);
  void checkAll();
  void checkNone();
  void readRow(QTreeWidgetItem* row, int column);

private:
  Q_DISABLE_COPY(pqLabelTablePropertyWidget)

  void buildPanel();
  /** Takes over what is checked, and tells of it. */
  void readTable();
  void checkShownRows(bool yes);
  void showNote();
  bool isBackground(int label) const;

  struct Internals;
  std::unique_ptr<Internals> Parts;
};

#endif
