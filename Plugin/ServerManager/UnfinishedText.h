// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicUnfinishedText_h
#define volumicUnfinishedText_h

#include "vtkServerManagerVolumicModule.h" // For export macro

#include <vtkNew.h>
#include <vtkTextActor.h>
#include <vtkWeakPointer.h>

#include <string>

class vtkPVDataInformation;
class vtkRenderer;
class vtkSMProxy;

namespace volumic
{
/** Why a run was stopped on its way that has given this: its StopReason; empty: it was not. */
VTKSERVERMANAGERVOLUMIC_EXPORT std::string WhyUnfinished(vtkPVDataInformation* surfaces);

/**
 * What a view says of a surface that has been stopped on its way, such as "unfinished (cancelled,
 * level 1 of 0)"; empty for one that is finished.
 * @param filter that has made it, whose FinestLevel tells where it was to end
 */
std::string TellUnfinished(vtkPVDataInformation* surfaces, vtkSMProxy* filter);

/** A text at the upper left corner of a view, for as long as this object lives. */
class UnfinishedText
{
public:
  UnfinishedText();
  ~UnfinishedText();

  /** Shows the text in the view, a render view; an empty one hides it. */
  void Show(vtkSMProxy* view, const std::string& text);
  void Hide() { this->Actor->VisibilityOff(); }

private:
  vtkNew<vtkTextActor> Actor;
  vtkWeakPointer<vtkRenderer> Renderer; ///< that it is in
};
}

#endif
