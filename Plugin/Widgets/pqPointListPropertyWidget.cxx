// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "pqPointListPropertyWidget.h"

#include "vtkDeformableSurface.h"

#include <pqApplicationCore.h>
#include <pqCoreUtilities.h>
#include <pqKeySequences.h>
#include <pqModalShortcut.h>
#include <pqQVTKWidget.h>
#include <pqRenderView.h>
#include <pqServerManagerModel.h>
#include <pqShortcutDecorator.h>

#include <vtk3DWidgetRepresentation.h>
#include <vtkActor.h>
#include <vtkCamera.h>
#include <vtkCellPicker.h>
#include <vtkCommand.h>
#include <vtkCurveRepresentation.h>
#include <vtkNew.h>
#include <vtkPVXMLElement.h>
#include <vtkPointData.h>
#include <vtkPolyData.h>
#include <vtkPolyDataMapper.h>
#include <vtkProperty.h>
#include <vtkRenderWindowInteractor.h>
#include <vtkRenderer.h>
#include <vtkSMNewWidgetRepresentationProxy.h>
#include <vtkSMPropertyGroup.h>
#include <vtkSMPropertyHelper.h>
#include <vtkSMRenderViewProxy.h>
#include <vtkSMUncheckedPropertyHelper.h>
#include <vtkWeakPointer.h>

#include <QCheckBox>
#include <QEvent>
#include <QGridLayout>
#include <QHeaderView>
#include <QKeySequence>
#include <QLabel>
#include <QMainWindow>
#include <QPushButton>
#include <QSignalBlocker>
#include <QStatusBar>
#include <QTableWidget>

#include <algorithm>
#include <vector>

namespace
{
/** Return an attribute of the hint PointList of a property. */
bool HintOf(vtkSMProperty* property, const char* name, int value)
{
  vtkPVXMLElement* hints = property->GetHints();
  vtkPVXMLElement* list = hints ? hints->FindNestedElementByName("PointList") : nullptr;
  if (list)
  {
    list->GetScalarAttribute(name, &value);
  }
  return value != 0;
}

vtkCurveRepresentation* HandlesOf(vtkSMProxy* widget)
{
  auto* made = vtk3DWidgetRepresentation::SafeDownCast(widget->GetClientSideObject());
  return vtkCurveRepresentation::SafeDownCast(made->GetRepresentation());
}

/**
 * Find the point under the mouse on surfaces and slices, by the depth buffer. With remote rendering
 * use ParaView's picking, on surfaces only. ParaView 5.13 has no depths of the faint actor.
 */
bool PickIn(vtkSMRenderViewProxy* view, vtkActor* faint, double position[3])
{
  const int* mouse = view->GetInteractor()->GetEventPosition();
  vtkRenderer* renderer = view->GetRenderer();
  double depth = renderer->GetZ(mouse[0], mouse[1]);
  vtkNew<vtkCellPicker> picker;
  picker->PickFromListOn();
  picker->AddPickList(faint);
  faint->SetPickable(renderer->HasViewProp(faint));
  if (picker->Pick(mouse[0], mouse[1], 0.0, renderer))
  {
    std::copy_n(picker->GetPickPosition(), 3, position);
    renderer->WorldToDisplay(position[0], position[1], position[2]);
    depth = std::min(depth, position[2]);
  }
  faint->PickableOff();
  if (depth >= 1.0)
  {
    double normal[3];
    return view->ConvertDisplayToPointOnSurface(mouse, position, normal, false);
  }
  renderer->SetDisplayPoint(mouse[0], mouse[1], depth);
  renderer->DisplayToWorld();
  const double* world = renderer->GetWorldPoint();
  std::transform(world, world + 3, position, [&](double x) { return x / world[3]; });
  return true;
}
}

//------------------------------------------------------------------------------
struct pqPointListPropertyWidget::Internals
{
  QLabel* Title = nullptr;
  QLabel* Note = nullptr;
  QTableWidget* Table = nullptr;
  QCheckBox* Show = nullptr;
  QPushButton* Remove = nullptr;
  QList<QVariant> Coordinates;
  int Row = -1; ///< in the panel if the points do not select components
  vtkNew<vtkPolyDataMapper> LeftOut;
  vtkNew<vtkActor> LeftOutActor;
  vtkWeakPointer<vtkRenderer> Renderer; ///< of LeftOutActor
};

//------------------------------------------------------------------------------
pqPointListPropertyWidget::pqPointListPropertyWidget(
  vtkSMProxy* proxy, vtkSMProperty* property, QWidget* parent)
  : Superclass("representations", "PolyLineWidgetRepresentation", proxy,
      vtkNew<vtkSMPropertyGroup>(), parent),
    Parts(new Internals)
{
  this->setProperty(property);
  this->setShowLabel(false);
  this->setChangeAvailableAsChangeFinished(false);
  this->buildPanel();

  vtkCurveRepresentation* handles = HandlesOf(this->widgetProxy());
  handles->SetDirectional(false);
  for (vtkProperty* line : { handles->GetLineProperty(), handles->GetSelectedLineProperty() })
  {
    line->SetOpacity(0.0); // so it cannot be grabbed either
  }
  for (vtkProperty* handle : { handles->GetHandleProperty(), handles->GetSelectedHandleProperty() })
  {
    handle->SetColor(1.0, 0.0, 1.0); // stands out from slices
    handle->LightingOff();
  }
  this->connect(this, SIGNAL(interaction()), SLOT(readHandles()));
  this->addPropertyLink(this, "coordinates", SIGNAL(coordinatesChanged()), property);
  this->placeHandles();

  this->Parts->LeftOut->ScalarVisibilityOff();
  this->Parts->LeftOutActor->SetMapper(this->Parts->LeftOut);
  this->Parts->LeftOutActor->GetProperty()->SetOpacity(0.3);
  this->Parts->LeftOutActor->GetProperty()->BackfaceCullingOn();
  this->Parts->LeftOutActor->PickableOff();
  if (HintOf(property, "selects", 0))
  {
    pqCoreUtilities::connect(proxy->GetProperty("KeepComponents"),
      vtkCommand::UncheckedPropertyModifiedEvent, this, SLOT(updateRow()));
    this->connect(pqApplicationCore::instance()->getServerManagerModel(),
      SIGNAL(dataUpdated(pqPipelineSource*)), SLOT(forgetLeftOut()));
  }

  pqModalShortcut* key =
    pqKeySequences::instance().addModalShortcut(QKeySequence(tr("P")), nullptr, this);
  (new pqShortcutDecorator(this))->addShortcut(key);
  this->connect(key, SIGNAL(activated()), SLOT(pick()));
  QObject::connect(this, &pqPropertyWidget::viewChanged, key,
    [this, key](pqView* view)
    {
      if (auto* area = qobject_cast<pqQVTKWidget*>(view ? view->widget() : nullptr))
      {
        key->setContextWidget(area);
        area->renderWidget()->installEventFilter(this);
      }
    });
}

pqPointListPropertyWidget::~pqPointListPropertyWidget()
{
  this->showLeftOut(false);
}

//------------------------------------------------------------------------------
void pqPointListPropertyWidget::buildPanel()
{
  Internals& parts = *this->Parts;
  auto* grid = new QGridLayout(this);
  grid->setContentsMargins(0, 0, 0, 0);
  grid->setVerticalSpacing(3);
  parts.Title = new QLabel(this->property()->GetXMLLabel(), this);
  parts.Title->setObjectName("Title");
  grid->addWidget(parts.Title, 0, 0, 1, -1);

  parts.Table = new QTableWidget(0, 3, this);
  parts.Table->setObjectName("Points");
  parts.Table->setHorizontalHeaderLabels({ "X", "Y", "Z" });
  parts.Table->horizontalHeader()->setSectionResizeMode(QHeaderView::Stretch);
  parts.Table->setSelectionBehavior(QAbstractItemView::SelectRows);
  parts.Table->setFixedHeight(4 * parts.Table->verticalHeader()->defaultSectionSize());
  grid->addWidget(parts.Table, 1, 0, 1, -1);

  auto* add = new QPushButton(tr("Add"), this);
  add->setObjectName("Add");
  grid->addWidget(add, 2, 0);
  parts.Remove = new QPushButton(tr("Remove"), this);
  parts.Remove->setObjectName("Remove");
  grid->addWidget(parts.Remove, 2, 1);

  parts.Show = new QCheckBox(tr("Show Points"), this);
  parts.Show->setObjectName("ShowPoints");
  parts.Show->setChecked(HintOf(this->property(), "show", 1));
  grid->addWidget(parts.Show, 3, 0, 1, -1);
  parts.Note = new QLabel(this);
  parts.Note->setWordWrap(true);
  grid->addWidget(parts.Note, 4, 0, 1, -1);

  this->connect(add, SIGNAL(clicked()), SLOT(addPointInTheCentre()));
  this->connect(parts.Remove, SIGNAL(clicked()), SLOT(removeSelectedPoints()));
  this->connect(
    parts.Table, SIGNAL(itemChanged(QTableWidgetItem*)), SLOT(readCell(QTableWidgetItem*)));
  this->connect(parts.Show, SIGNAL(toggled(bool)), SLOT(setWidgetVisible(bool)));
  this->fillTable();
}

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
    // Points are counted from 0, as in messages of the filter.
    parts.Table->setVerticalHeaderItem(row, new QTableWidgetItem(QString::number(row)));
    for (int axis = 0; axis < 3; ++axis)
    {
      const double value = parts.Coordinates[3 * row + axis].toDouble();
      parts.Table->setItem(row, axis, new QTableWidgetItem(QString::number(value)));
    }
  }
  parts.Remove->setEnabled(n > 0);
  this->updateRow();
}

void pqPointListPropertyWidget::addPoint(const double position[3])
{
  this->change(
    QList<QVariant>(this->Parts->Coordinates) << position[0] << position[1] << position[2]);
  this->Parts->Table->setCurrentCell(this->Parts->Table->rowCount() - 1, 0);
  Q_EMIT this->changeFinished();
}

void pqPointListPropertyWidget::pick()
{
  double position[3];
  auto* view = qobject_cast<pqRenderView*>(this->view());
  const bool isFound =
    view && PickIn(view->getRenderViewProxy(), this->Parts->LeftOutActor, position);
  if (auto* window = qobject_cast<QMainWindow*>(pqCoreUtilities::mainWidget()))
  {
    window->statusBar()->showMessage(
      isFound ? QString() : tr("No surface or slice under the mouse"));
  }
  if (isFound)
  {
    this->addPoint(position);
  }
}

void pqPointListPropertyWidget::addPointInTheCentre()
{
  double centre[3] = { 0.0, 0.0, 0.0 };
  if (auto* view = qobject_cast<pqRenderView*>(this->view()))
  {
    view->getRenderViewProxy()->GetActiveCamera()->GetFocalPoint(centre);
  }
  this->addPoint(centre);
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

void pqPointListPropertyWidget::placeHandles()
{
  std::vector<double> positions;
  for (const QVariant& x : this->Parts->Coordinates)
  {
    positions.push_back(x.toDouble());
  }
  // A poly line has at least one point. Hide it if the list is empty.
  vtkCurveRepresentation* handles = HandlesOf(this->widgetProxy());
  handles->GetHandleProperty()->SetOpacity(positions.empty() ? 0.0 : 1.0);
  if (!positions.empty())
  {
    vtkSMPropertyHelper(this->widgetProxy(), "HandlePositions")
      .Set(positions.data(), static_cast<unsigned int>(positions.size()));
    this->widgetProxy()->UpdateVTKObjects();
  }
  this->render();
}

void pqPointListPropertyWidget::readHandles()
{
  vtkCurveRepresentation* handles = HandlesOf(this->widgetProxy());
  QList<QVariant> coordinates;
  for (int i = 0; i < handles->GetNumberOfHandles(); ++i)
  {
    const double* position = handles->GetHandlePosition(i);
    coordinates << position[0] << position[1] << position[2];
  }
  this->Parts->Coordinates = coordinates;
  this->fillTable();
  Q_EMIT this->coordinatesChanged();
}

bool pqPointListPropertyWidget::selectsComponents() const
{
  if (!HintOf(this->property(), "selects", 0))
  {
    return false;
  }
  const int keep = vtkSMUncheckedPropertyHelper(this->proxy(), "KeepComponents").GetAsInt();
  return keep == vtkDeformableSurface::ComponentsAtPoints ||
    keep == vtkDeformableSurface::ComponentsNotAtSeeds;
}

void pqPointListPropertyWidget::updateRow()
{
  Internals& parts = *this->Parts;
  const bool selects = this->selectsComponents();
  parts.Title->setText(selects ? tr("Points") : tr(this->property()->GetXMLLabel()));
  parts.Note->setText(
    (selects && parts.Coordinates.empty() ? tr("<b>No points: all components are kept.</b> ")
                                          : QString()) +
    tr("<b>P</b> adds the point under the mouse, on a surface or a slice, while points are shown. "
       "Drag a point to move it."));
  auto* grid =
    qobject_cast<QGridLayout*>(this->parentWidget() ? this->parentWidget()->layout() : nullptr);
  QWidget* replaced =
    selects ? this->parentWidget()->findChild<QWidget*>("MinimumComponentVolume") : nullptr;
  if (!grid || grid->indexOf(this) < 0)
  {
    return;
  }
  const auto rowOf = [grid](QWidget* widget)
  {
    int row, column, spans[2];
    grid->getItemPosition(grid->indexOf(widget), &row, &column, &spans[0], &spans[1]);
    return row;
  };
  parts.Row = parts.Row < 0 ? rowOf(this) : parts.Row;
  grid->removeWidget(this);
  grid->addWidget(this, replaced ? rowOf(replaced) : parts.Row, 0, 1, -1);
  this->updateWidgetVisibility();
}

void pqPointListPropertyWidget::showEvent(QShowEvent*)
{
  this->updateRow();
  this->setWidgetVisible(this->Parts->Show->isChecked());
}

void pqPointListPropertyWidget::hideEvent(QHideEvent*)
{
  this->setWidgetVisible(false);
}

bool pqPointListPropertyWidget::eventFilter(QObject* object, QEvent* event)
{
  if (event->type() == QEvent::Enter && this->isWidgetVisible())
  {
    static_cast<QWidget*>(object)->setFocus(); // for the key P, also after a click on Apply
  }
  return this->Superclass::eventFilter(object, event);
}

void pqPointListPropertyWidget::updateWidgetVisibility()
{
  this->Superclass::updateWidgetVisibility();
  this->showLeftOut(
    this->isSelected() && this->isWidgetVisible() && this->view() && this->selectsComponents());
  this->render();
}

void pqPointListPropertyWidget::forgetLeftOut()
{
  this->Parts->LeftOut->SetInputData(nullptr);
  this->updateWidgetVisibility();
}

void pqPointListPropertyWidget::showLeftOut(bool isShown)
{
  Internals& parts = *this->Parts;
  if (parts.Renderer)
  {
    parts.Renderer->RemoveActor(parts.LeftOutActor);
  }
  auto* view = qobject_cast<pqRenderView*>(this->view());
  // Null on a remote server.
  auto* filter = vtkDeformableSurface::SafeDownCast(this->proxy()->GetClientSideObject());
  if (!isShown || !view || !filter)
  {
    return;
  }
  if (!parts.LeftOut->GetInput())
  {
    vtkNew<vtkPolyData> shape;
    if (const vtkSmartPointer<vtkPolyData> leftOut = filter->NewLeftOutComponents())
    {
      shape->CopyStructure(leftOut);
      shape->GetPointData()->SetNormals(leftOut->GetPointData()->GetNormals());
    }
    parts.LeftOut->SetInputData(shape);
  }
  parts.Renderer = view->getRenderViewProxy()->GetRenderer();
  parts.Renderer->AddActor(parts.LeftOutActor);
}
