// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef pqPointListPropertyWidget_h
#define pqPointListPropertyWidget_h

#include <pqPropertyWidget.h>

#include <QList>
#include <QVariant>

#include <memory>

class QTableWidgetItem;

/**
 * A list of points for a repeatable property of three numbers each: a table, and in the view a
 * handle of ParaView's per point. `P` adds the point of a surface or slice under the mouse, Ctrl+P
 * the mesh's point that is nearest to it; a handle can be dragged. A new point of the button Add
 * lies in the centre of the input.
 *
 *   <DoubleVectorProperty panel_widget="PointList" ...>
 *     <Hints>
 *       <PointList show="0"/>  <!-- handles only where Show Points is checked; default: 1 -->
 */
class pqPointListPropertyWidget : public pqPropertyWidget
{
  Q_OBJECT
  /** x, y and z of each point. */
  Q_PROPERTY(QList<QVariant> coordinates READ coordinates WRITE setCoordinates)
  using Superclass = pqPropertyWidget;

public:
  pqPointListPropertyWidget(
    vtkSMProxy* proxy, vtkSMProperty* property, QWidget* parent = nullptr);
  ~pqPointListPropertyWidget() override;

  QList<QVariant> coordinates() const;
  void setCoordinates(const QList<QVariant>& coordinates);

  void select() override;
  void deselect() override;

public Q_SLOTS:
  void setView(pqView* view) override;

Q_SIGNALS:
  void coordinatesChanged();
  /** Whether the handles are shown; ParaView's keys for picking follow it. */
  void widgetVisibilityUpdated(bool);

protected:
  void showEvent(QShowEvent* event) override;
  void hideEvent(QHideEvent* event) override;

private Q_SLOTS:
  void addPoint(double x, double y, double z);
  void addPointOfSlice();
  void addPointInTheCentre();
  void removeSelectedPoints();
  void removeAllPoints();
  void readCell(QTableWidgetItem* item);
  void updateVisibility();

private:
  Q_DISABLE_COPY(pqPointListPropertyWidget)

  void buildPanel();
  /** Takes over new coordinates, in the table and the handles, and tells of them. */
  void change(const QList<QVariant>& coordinates);
  void fillTable();
  void placeHandles();
  /** Takes over the position to which a handle is dragged. */
  void followHandle(int index, const double position[3]);
  void render();

  struct Internals;
  std::unique_ptr<Internals> Parts;
};

#endif
