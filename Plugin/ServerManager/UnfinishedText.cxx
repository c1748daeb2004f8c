// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "UnfinishedText.h"

#include <vtkCoordinate.h>
#include <vtkDataObject.h>
#include <vtkPVArrayInformation.h>
#include <vtkPVDataInformation.h>
#include <vtkPVRenderView.h>
#include <vtkRenderer.h>
#include <vtkSMPropertyHelper.h>
#include <vtkSMProxy.h>
#include <vtkTextProperty.h>

namespace volumic
{
//------------------------------------------------------------------------------
std::string WhyUnfinished(vtkPVDataInformation* surfaces)
{
  // Of blocks there is one each.
  vtkPVArrayInformation* reasons =
    surfaces->GetArrayInformation("StopReason", vtkDataObject::FIELD);
  for (int i = 0; reasons && i < reasons->GetNumberOfStringValues(); ++i)
  {
    const std::string reason = reasons->GetStringValue(i);
    if (reason == "cancelled" || reason == "time limit")
    {
      return reason;
    }
  }
  return "";
}

//------------------------------------------------------------------------------
std::string TellUnfinished(vtkPVDataInformation* surfaces, vtkSMProxy* filter)
{
  const std::string reason = WhyUnfinished(surfaces);
  if (reason.empty())
  {
    return "";
  }
  vtkPVArrayInformation* level = surfaces->GetArrayInformation("Level", vtkDataObject::FIELD);
  std::string text = "unfinished (" + reason;
  if (level && surfaces->GetNumberOfCells() > 0 && !surfaces->IsCompositeDataSet())
  {
    text += ", level " + std::to_string(static_cast<int>(level->GetComponentRange(0)[0]));
    const bool isPlanned = filter && filter->GetProperty("EdgeLength") &&
      vtkSMPropertyHelper(filter, "EdgeLength").GetAsDouble() != 0.0;
    const bool goesFurther = filter && filter->GetProperty("ThinParts") &&
      vtkSMPropertyHelper(filter, "ThinParts").GetAsInt() != 0; // To level -1, perhaps.
    text += filter && filter->GetProperty("FinestLevel") && !isPlanned && !goesFurther
      ? " of " + std::to_string(vtkSMPropertyHelper(filter, "FinestLevel").GetAsInt())
      : "";
  }
  return text + ")";
}

//------------------------------------------------------------------------------
UnfinishedText::UnfinishedText()
{
  this->Actor->GetPositionCoordinate()->SetCoordinateSystemToNormalizedViewport();
  this->Actor->SetPosition(0.02, 0.97);
  vtkTextProperty* style = this->Actor->GetTextProperty();
  style->SetFontSize(18);
  style->SetVerticalJustificationToTop();
  style->SetColor(1.0, 1.0, 1.0);
  style->SetBackgroundColor(0.6, 0.1, 0.1);
  style->SetBackgroundOpacity(0.8);
}

UnfinishedText::~UnfinishedText()
{
  if (this->Renderer)
  {
    this->Renderer->RemoveViewProp(this->Actor);
  }
}

//------------------------------------------------------------------------------
void UnfinishedText::Show(vtkSMProxy* view, const std::string& text)
{
  auto* shown = vtkPVRenderView::SafeDownCast(view->GetClientSideObject());
  if (shown && !this->Renderer && !text.empty())
  {
    // Beside what servers draw, if there are any.
    this->Renderer = shown->GetRenderer(vtkPVRenderView::NON_COMPOSITED_RENDERER);
    this->Renderer->AddViewProp(this->Actor);
  }
  this->Actor->SetInput(text.c_str());
  this->Actor->SetVisibility(text.empty() ? 0 : 1);
}
}
