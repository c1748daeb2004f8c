// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef pqPointListPropertyWidget_h
#define pqPointListPropertyWidget_h

#include <pqInteractivePropertyWidget.h>

#include <QList>
#include <QVariant>

#include <memory>

class QTableWidgetItem;

/**
 * A list of points for a repeatable property with three numbers per point: a table, and in the view
 * the handles of ParaView's poly line without the line. `P` adds the point under the mouse, on a
 * surface or a slice. Handles can be dragged.
 *
 *   <DoubleVectorProperty panel_widget="PointList" ...>
 *     <Hints>
 *       <PointList show="0" selects="1"/>
 *
 * show: whether Show Points is initially checked (default: 1). selects: the points also select
 * components, depending on KeepComponents. The list is then named Points, in the row of
 * MinimumComponentVolume, and the view has a faint surface of all removed components.
 */
class pqPointListPropertyWidget : public pqInteractivePropertyWidget
{
  Q_OBJECT
  /** x, y and z of each point. */
  Q_PROPERTY(QList<QVariant> coordinates READ coordinates WRITE setCoordinates)
  using Superclass = pqInteractivePropertyWidget;

public:
  pqPointListPropertyWidget(vtkSMProxy* proxy, vtkSMProperty* property, QWidget* parent = nullptr);
  ~pqPointListPropertyWidget() override;

  QList<QVariant> coordinates() const;
  void setCoordinates(const QList<QVariant>& coordinates);

  void showEvent(QShowEvent* event) override;
  void hideEvent(QHideEvent* event) override;
  bool eventFilter(QObject* object, QEvent* event) override;

Q_SIGNALS:
  void coordinatesChanged();

protected Q_SLOTS:
  void placeWidget() override {}
  void updateWidgetVisibility() override;

private Q_SLOTS:
  void pick();
  void addPointInTheCentre();
  void removeSelectedPoints();
  void readCell(QTableWidgetItem* item);
  /** Set the coordinates to the positions of the handles. */
  void readHandles();
  void updateRow();
  /** Called if the removed components have changed. */
  void forgetLeftOut();

private:
  Q_DISABLE_COPY(pqPointListPropertyWidget)

  void buildPanel();
  void addPoint(const double position[3]);
  /** Set the coordinates in the table and the handles, and emit coordinatesChanged(). */
  void change(const QList<QVariant>& coordinates);
  void fillTable();
  void placeHandles();
  bool selectsComponents() const;
  void showLeftOut(bool isShown);

  struct Internals;
  std::unique_ptr<Internals> Parts;
};

#endif
