// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef pqLabelTablePropertyWidget_h
#define pqLabelTablePropertyWidget_h

#include <pqPropertyWidget.h>

#include <QList>
#include <QVariant>

#include <memory>

class QStandardItem;

/**
 * A table of the labels of the input, for a property that lists some of them. An empty list means
 * all labels except BackgroundLabel. A row has a box, the colour, the name, the value and the
 * number of voxels. A click on a title sorts. Search hides the rows that do not contain its text.
 * All checks the visible rows, Only These unchecks all others. The box of one of several selected
 * rows sets the boxes of all of them. At least one row stays checked.
 *
 *   <IntVectorProperty panel_widget="LabelTable" ...>
 *     <LabelsDomain .../>
 */
class pqLabelTablePropertyWidget : public pqPropertyWidget
{
  Q_OBJECT
  Q_PROPERTY(QList<QVariant> labels READ labels WRITE setLabels)
  using Superclass = pqPropertyWidget;

public:
  pqLabelTablePropertyWidget(vtkSMProxy* proxy, vtkSMProperty* property, QWidget* parent = nullptr);
  ~pqLabelTablePropertyWidget() override;

  QList<QVariant> labels() const;
  void setLabels(const QList<QVariant>& labels);

Q_SIGNALS:
  void labelsChanged();

private Q_SLOTS:
  /** List the labels of the current input. */
  void fillTable();
  /** Check the labels that the property lists. */
  void checkRows();
  void showNote();
  void search(const QString& text);
  void checkAll();
  void checkOnlyThese();
  void readRow(QStandardItem* item);

private:
  Q_DISABLE_COPY(pqLabelTablePropertyWidget)

  void buildPanel();
  /** Set the property to the checked labels. */
  void readTable();
  bool isBackground(int label) const;

  struct Internals;
  std::unique_ptr<Internals> Parts;
};

#endif
