// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "pqPointListPropertyWidget.h"

#include "PickOnSlices.h"
#include "PointHandles.h"

#include <pqModalShortcut.h>
#include <pqPointPickingHelper.h>
#include <pqRenderView.h>
#include <pqUndoStack.h>

#include <vtkBoundingBox.h>
#include <vtkPVDataInformation.h>
#include <vtkPVXMLElement.h>
#include <vtkSMProperty.h>
#include <vtkSMSourceProxy.h>
#include <vtkSMUncheckedPropertyHelper.h>

#include <QCheckBox>
#include <QGridLayout>
#include <QHeaderView>
#include <QKeySequence>
#include <QLabel>
#include <QPushButton>
#include <QSignalBlocker>
#include <QTableWidget>

#include <cstddef>
#include <vector>

namespace
{
/** Whether the handles are to be shown before the user says something. */
bool AreHandlesShownFirst(vtkSMProperty* property)
{
  vtkPVXMLElement* hints = property->GetHints();
  vtkPVXMLElement* list = hints ? hints->FindNestedElementByName("PointList") : nullptr;
  int show = 1;
  return !list || !list->GetScalarAttribute("show", &show) || show != 0;
}

/** Invalid where the input isn't known. */
vtkBoundingBox BoundsOfInput(vtkSMProxy* filter)
{
  vtkBoundingBox box;
  vtkSMProperty* input = filter->GetProperty("Input");
  if (input)
  {
    vtkSMUncheckedPropertyHelper source(input);
    auto* producer = vtkSMSourceProxy::SafeDownCast(
      source.GetNumberOfElements() > 0 ? source.GetAsProxy() : nullptr);
    if (producer)
    {
      box.SetBounds(producer->GetDataInformation(source.GetOutputPort())->GetBounds());
    }
  }
  return box;
}
}

//------------------------------------------------------------------------------
struct pqPointListPropertyWidget::Internals
{
  explicit Internals(pqPointListPropertyWidget* widget)
    : Handles([widget](std::size_t index, const PointHandles::Position& position)
        { widget->followHandle(static_cast<int>(index), position.data()); },
        [widget] { Q_EMIT widget->changeFinished(); })
  {
  }

  QTableWidget* Table = nullptr;
  QCheckBox* Show = nullptr;
  QPushButton* Remove = nullptr;
  QPushButton* RemoveAll = nullptr;
  QList<QVariant> Coordinates;
  PointHandles Handles; ///< one per point
};

//------------------------------------------------------------------------------
pqPointListPropertyWidget::pqPointListPropertyWidget(
  vtkSMProxy* proxy, vtkSMProperty* property, QWidget* parent)
  : Superclass(proxy, parent)
  , Parts(new Internals(this))
{
  this->setProperty(property);
  this->setShowLabel(false);
  this->setChangeAvailableAsChangeFinished(false);
  this->buildPanel();
  this->addPropertyLink(this, "coordinates", SIGNAL(coordinatesChanged()), property);
  for (const bool onMesh : { false, true })
  {
    auto* picking =
      new pqPointPickingHelper(QKeySequence(onMesh ? tr("Ctrl+P") : tr("P")), onMesh, this);
    picking->connect(this, SIGNAL(viewChanged(pqView*)), SLOT(setView(pqView*)));
    this->connect(picking, SIGNAL(pick(double, double, double)),
      SLOT(addPoint(double, double, double)));
  }
  for (pqModalShortcut* key : this->findChildren<pqModalShortcut*>())
  {
    this->connect(key, SIGNAL(activated()), SLOT(addPointOfSlice()));
  }
}

pqPointListPropertyWidget::~pqPointListPropertyWidget()
{
  this->Parts->Coordinates.clear();
  this->placeHandles();
}

//------------------------------------------------------------------------------
void pqPointListPropertyWidget::buildPanel()
{
  Internals& parts = *this->Parts;
  auto* grid = new QGridLayout(this);
  grid->setContentsMargins(0, 0, 0, 0);
  grid->setVerticalSpacing(3);
  grid->addWidget(new QLabel(this->property()->GetXMLLabel(), this), 0, 0, 1, -1);

  parts.Table = new QTableWidget(0, 3, this);
  parts.Table->setObjectName("Points");
  parts.Table->setHorizontalHeaderLabels({ "X", "Y", "Z" });
  parts.Table->horizontalHeader()->setSectionResizeMode(QHeaderView::Stretch);
  parts.Table->setSelectionBehavior(QAbstractItemView::SelectRows);
  parts.Table->setMinimumHeight(5 * parts.Table->verticalHeader()->defaultSectionSize());
  parts.Table->setMaximumHeight(parts.Table->minimumHeight());
  grid->addWidget(parts.Table, 1, 0, 1, -1);

  const auto button = [&](const char* name, const QString& text, int column)
  {
    auto* made = new QPushButton(text, this);
    made->setObjectName(name);
    grid->addWidget(made, 2, column);
    return made;
  };
  this->connect(
    button("Add", tr("Add"), 0), SIGNAL(clicked()), SLOT(addPointInTheCentre()));
  parts.Remove = button("Remove", tr("Remove"), 1);
  this->connect(parts.Remove, SIGNAL(clicked()), SLOT(removeSelectedPoints()));
  parts.RemoveAll = button("RemoveAll", tr("Remove All"), 2);
  this->connect(parts.RemoveAll, SIGNAL(clicked()), SLOT(removeAllPoints()));

  parts.Show = new QCheckBox(tr("Show Points"), this);
  parts.Show->setObjectName("ShowPoints");
  parts.Show->setChecked(AreHandlesShownFirst(this->property()));
  grid->addWidget(parts.Show, 3, 0, 1, -1);
  auto* note = new QLabel(
    tr("<b>Note:</b> While they are shown, <b>P</b> adds the point under the mouse (Ctrl+P: the "
       "nearest point of the mesh), on a slice or a surface; drag a point to move it."),
    this);
  note->setWordWrap(true);
  grid->addWidget(note, 4, 0, 1, -1);

  this->connect(parts.Table, SIGNAL(itemChanged(QTableWidgetItem*)),
    SLOT(readCell(QTableWidgetItem*)));
  this->connect(parts.Show, SIGNAL(toggled(bool)), SLOT(updateVisibility()));
  this->fillTable();
}

//------------------------------------------------------------------------------
QList<QVariant> pqPointListPropertyWidget::coordinates() const
{
  return this->Parts->Coordinates;
}

void pqPointListPropertyWidget::setCoordinates(const QList<QVariant>& coordinates)
{
  if (coordinates != this->Parts->Coordinates)
  {
    this->change(coordinates);
  }
}

void pqPointListPropertyWidget::change(const QList<QVariant>& coordinates)
{
  this->Parts->Coordinates = coordinates;
  this->fillTable();
  this->placeHandles();
  this->render();
  Q_EMIT this->coordinatesChanged();
}

void pqPointListPropertyWidget::fillTable()
{
  Internals& parts = *this->Parts;
  const QSignalBlocker blocker(parts.Table);
  const int n = static_cast<int>(parts.Coordinates.size()) / 3;
  parts.Table->setRowCount(n);
  for (int row = 0; row < n; ++row)
  {
    // As in messages of the filter, points are counted from 0.
    parts.Table->setVerticalHeaderItem(row, new QTableWidgetItem(QString::number(row)));
    for (int axis = 0; axis < 3; ++axis)
    {
      const double value = parts.Coordinates[3 * row + axis].toDouble();
      parts.Table->setItem(row, axis, new QTableWidgetItem(QString::number(value)));
    }
  }
  parts.Remove->setEnabled(n > 0);
  parts.RemoveAll->setEnabled(n > 0);
}

//------------------------------------------------------------------------------
void pqPointListPropertyWidget::addPoint(double x, double y, double z)
{
  this->change(QList<QVariant>(this->Parts->Coordinates) << x << y << z);
  this->Parts->Table->setCurrentCell(this->Parts->Table->rowCount() - 1, 0);
  Q_EMIT this->changeFinished();
}

void pqPointListPropertyWidget::addPointOfSlice()
{
  double place[3];
  if (PickOnSlices(qobject_cast<pqRenderView*>(this->view()), place))
  {
    this->addPoint(place[0], place[1], place[2]);
  }
}

void pqPointListPropertyWidget::addPointInTheCentre()
{
  const vtkBoundingBox box = BoundsOfInput(this->proxy());
  double place[3] = { 0.0, 0.0, 0.0 };
  double step = 1.0;
  if (box.IsValid())
  {
    box.GetCenter(place);
    step = 0.05 * box.GetDiagonalLength();
  }
  // Beside those that have been added before.
  const QList<QVariant>& taken = this->Parts->Coordinates;
  for (int i = 0; i + 2 < taken.size(); i += 3)
  {
    if (taken[i].toDouble() == place[0] && taken[i + 1].toDouble() == place[1] &&
      taken[i + 2].toDouble() == place[2])
    {
      place[0] += step;
      i = -3;
    }
  }
  this->addPoint(place[0], place[1], place[2]);
}

void pqPointListPropertyWidget::removeSelectedPoints()
{
  QTableWidget* table = this->Parts->Table;
  QList<QVariant> kept;
  for (int row = 0; row < table->rowCount(); ++row)
  {
    if (!table->selectionModel()->isRowSelected(row, QModelIndex()) && row != table->currentRow())
    {
      kept << this->Parts->Coordinates.mid(3 * row, 3);
    }
  }
  this->change(kept);
  Q_EMIT this->changeFinished();
}

void pqPointListPropertyWidget::removeAllPoints()
{
  this->change({});
  Q_EMIT this->changeFinished();
}

void pqPointListPropertyWidget::readCell(QTableWidgetItem* item)
{
  bool isNumber = false;
  const double value = item->text().toDouble(&isNumber);
  QList<QVariant> coordinates = this->Parts->Coordinates;
  if (isNumber)
  {
    coordinates[3 * item->row() + item->column()] = value;
  }
  this->change(coordinates);
  Q_EMIT this->changeFinished();
}

//------------------------------------------------------------------------------
void pqPointListPropertyWidget::placeHandles()
{
  SCOPED_UNDO_EXCLUDE();
  const QList<QVariant>& coordinates = this->Parts->Coordinates;
  auto* view = qobject_cast<pqRenderView*>(this->view());
  std::vector<PointHandles::Position> positions;
  for (int i = 0; view && i + 2 < coordinates.size(); i += 3)
  {
    positions.push_back({ coordinates[i].toDouble(), coordinates[i + 1].toDouble(),
      coordinates[i + 2].toDouble() });
  }
  this->Parts->Handles.Place(view, positions);
  this->updateVisibility();
}

void pqPointListPropertyWidget::followHandle(int index, const double position[3])
{
  for (int axis = 0; axis < 3; ++axis)
  {
    this->Parts->Coordinates[3 * index + axis] = position[axis];
  }
  this->fillTable();
  Q_EMIT this->coordinatesChanged();
}

//------------------------------------------------------------------------------
void pqPointListPropertyWidget::setView(pqView* view)
{
  if (view == this->view())
  {
    return;
  }
  // The handles of the former view go, and come again in the new one.
  const QList<QVariant> coordinates = this->Parts->Coordinates;
  this->Parts->Coordinates.clear();
  this->placeHandles();
  this->render();
  this->Superclass::setView(view);
  this->Parts->Coordinates = coordinates;
  this->placeHandles();
  this->render();
}

void pqPointListPropertyWidget::select()
{
  this->Superclass::select();
  this->updateVisibility();
}

void pqPointListPropertyWidget::deselect()
{
  this->Superclass::deselect();
  this->updateVisibility();
}

void pqPointListPropertyWidget::showEvent(QShowEvent* event)
{
  this->Superclass::showEvent(event);
  this->updateVisibility();
}

void pqPointListPropertyWidget::hideEvent(QHideEvent* event)
{
  this->Superclass::hideEvent(event);
  this->updateVisibility();
}

void pqPointListPropertyWidget::updateVisibility()
{
  const bool isShown =
    this->isSelected() && this->isVisible() && this->view() && this->Parts->Show->isChecked();
  this->Parts->Handles.SetVisible(isShown);
  this->render();
  Q_EMIT this->widgetVisibilityUpdated(isShown);
}

void pqPointListPropertyWidget::render()
{
  if (this->view())
  {
    this->view()->render();
  }
}
