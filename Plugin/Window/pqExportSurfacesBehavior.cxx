// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "pqExportSurfacesBehavior.h"

#include "SurfaceSources.h"

#include <pqActiveObjects.h>
#include <pqCoreUtilities.h>
#include <pqDataRepresentation.h>
#include <pqFileDialog.h>
#include <pqOutputPort.h>
#include <pqPipelineSource.h>
#include <pqServer.h>

#include <vtkPVDataInformation.h>
#include <vtkSMPropertyHelper.h>
#include <vtkSMProxy.h>
#include <vtkSMSessionProxyManager.h>
#include <vtkSMSourceProxy.h>
#include <vtkSmartPointer.h>

#include <QAction>
#include <QMainWindow>
#include <QMenu>
#include <QTimer>

#include <string>
#include <vector>

namespace
{
const char* const Formats =
  "STL, a file each (*.stl);;PLY, a file each (*.ply);;OBJ, a file each (*.obj);;"
  "VTK, a file each (*.vtp);;glTF, all in one, with names and colours (*.glb);;"
  "3MF, all in one, for printers (*.3mf);;Tetrahedra of Interfaces (*.vtu);;"
  "CalculiX and Abaqus, tetrahedra of Interfaces (*.inp);;"
  "gmsh, volumes of Interfaces (*.msh);;TetGen, regions of Interfaces (*.smesh)";

/** Those of a display that shows some blocks only; empty: all are shown, or there is no display. */
std::vector<std::string> ShownBlocks(pqOutputPort* port)
{
  pqDataRepresentation* display =
    port->getRepresentation(pqActiveObjects::instance().activeView());
  vtkSMProxy* proxy = display ? display->getProxy() : nullptr;
  std::vector<std::string> blocks;
  if (proxy && proxy->GetProperty("BlockSelectors"))
  {
    vtkSMPropertyHelper selectors(proxy, "BlockSelectors");
    for (unsigned int i = 0; i < selectors.GetNumberOfElements(); ++i)
    {
      blocks.emplace_back(selectors.GetAsString(i));
    }
  }
  const bool areAll = blocks.size() == 1 && (blocks[0] == "/" || blocks[0] == "/Root");
  return areAll ? std::vector<std::string>() : blocks;
}

/** Not so tables, and what has not been made yet. */
bool HasCells(vtkPVDataInformation* data)
{
  return data && data->GetNumberOfCells() > 0 &&
    (data->IsCompositeDataSet() || data->DataSetTypeIsA("vtkDataSet"));
}

void Export(pqOutputPort* port, const std::string& file)
{
  vtkSMSessionProxyManager* manager = port->getServer()->proxyManager();
  vtkSMProxy* input = port->getSourceProxy();
  unsigned int number = static_cast<unsigned int>(port->getPortNumber());
  vtkSmartPointer<vtkSMProxy> shown;
  const std::vector<std::string> blocks = ShownBlocks(port);
  if (!blocks.empty())
  {
    shown.TakeReference(manager->NewProxy("filters", "ExtractBlock"));
    vtkSMPropertyHelper(shown, "Input").Set(input, number);
    vtkSMPropertyHelper selectors(shown, "Selectors");
    selectors.SetNumberOfElements(static_cast<unsigned int>(blocks.size()));
    for (unsigned int i = 0; i < blocks.size(); ++i)
    {
      selectors.Set(i, blocks[i].c_str());
    }
    shown->UpdateVTKObjects();
    input = shown;
    number = 0;
  }
  const auto writer =
    vtkSmartPointer<vtkSMProxy>::Take(manager->NewProxy("writers", "VolumicSurfaces"));
  vtkSMPropertyHelper(writer, "Input").Set(input, number);
  vtkSMPropertyHelper(writer, "FileName").Set(file.c_str());
  writer->UpdateVTKObjects();
  vtkSMSourceProxy::SafeDownCast(writer)->UpdatePipeline();
}
}

//------------------------------------------------------------------------------
pqExportSurfacesBehavior::pqExportSurfacesBehavior() = default;
pqExportSurfacesBehavior::~pqExportSurfacesBehavior() = default;

//------------------------------------------------------------------------------
void pqExportSurfacesBehavior::startup()
{
  this->connect(&pqActiveObjects::instance(), SIGNAL(portChanged(pqOutputPort*)), SLOT(enable()));
  this->connect(&pqActiveObjects::instance(), SIGNAL(dataUpdated()), SLOT(enable()));
  // Of a plugin that is loaded at the start the window has no menus yet.
  QTimer::singleShot(0, this, SLOT(addAction()));
}

//------------------------------------------------------------------------------
void pqExportSurfacesBehavior::shutdown()
{
  delete this->Action;
}

//------------------------------------------------------------------------------
void pqExportSurfacesBehavior::addAction()
{
  QWidget* window = pqCoreUtilities::mainWidget();
  auto* save = window ? window->findChild<QAction*>("actionFileSaveData") : nullptr;
  auto* menu = window ? window->findChild<QMenu*>("menu_File") : nullptr;
  if (!save || !menu || this->Action)
  {
    return;
  }
  this->Action = new QAction(tr("Export Surfaces..."), menu);
  this->Action->setObjectName("actionExportSurfaces");
  const QList<QAction*> entries = menu->actions();
  const int next = entries.indexOf(save) + 1;
  menu->insertAction(next < entries.size() ? entries[next] : nullptr, this->Action);
  this->connect(this->Action, SIGNAL(triggered()), SLOT(askAndExport()));
  this->enable();
}

//------------------------------------------------------------------------------
void pqExportSurfacesBehavior::enable()
{
  pqOutputPort* port = pqActiveObjects::instance().activePort();
  if (this->Action)
  {
    this->Action->setEnabled(
      port && volumic::IsOfSurface(port->getSource()) && HasCells(port->getDataInformation()));
  }
}

//------------------------------------------------------------------------------
void pqExportSurfacesBehavior::askAndExport()
{
  pqOutputPort* port = pqActiveObjects::instance().activePort();
  if (!port)
  {
    return;
  }
  pqFileDialog dialog(port->getServer(), pqCoreUtilities::mainWidget(), tr("Export Surfaces:"),
    QString(), Formats);
  dialog.setObjectName("ExportSurfacesDialog");
  dialog.setFileMode(pqFileDialog::AnyFile);
  if (dialog.exec() == QDialog::Accepted && !dialog.getSelectedFiles().isEmpty())
  {
    Export(port, dialog.getSelectedFiles().first().toUtf8().toStdString());
  }
}
