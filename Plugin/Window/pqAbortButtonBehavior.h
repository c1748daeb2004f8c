// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef pqAbortButtonBehavior_h
#define pqAbortButtonBehavior_h

#include <QElapsedTimer>
#include <QObject>
#include <QPointer>

#include <vtkWeakPointer.h>

class QAbstractButton;
class QEvent;
class pqPipelineSource;
class vtkAlgorithm;
class vtkObject;

/**
 * Lets the abort button in the status bar stop a run of Volumic's filters.
 *
 * ParaView 6.1 lights the button up while something runs, and looks for events with each progress,
 * but swallows all presses of the mouse: a press comes to the window first, which hands it on to
 * the button, and of the two only the button is on ParaView's list of exceptions. Before 6.1 the
 * button does not light up, and nobody looks for events: this does both.
 *
 * While a filter runs the window takes nothing but a press of that button: what shortcuts and
 * timers start would come upon a pipeline at work.
 *
 * Of the built-in server only: others run where the window can't reach them.
 */
class pqAbortButtonBehavior : public QObject
{
  Q_OBJECT

public:
  pqAbortButtonBehavior();
  ~pqAbortButtonBehavior() override;

  /** Called by ParaView when it has loaded the plugin, and when it ends. */
  void startup();
  void shutdown();

protected:
  bool eventFilter(QObject* object, QEvent* event) override;

private Q_SLOTS:
  void watch(pqPipelineSource* source);
  void onStart(vtkObject* filter);
  void onProgress();
  void onEnd();
  void stop();

private:
  /** Whether the event is a press of the button, on its way there. */
  bool isPressOfButton(QObject* object, QEvent* event) const;

  QPointer<QAbstractButton> Button;
  vtkWeakPointer<vtkAlgorithm> Running;
  QElapsedTimer SinceEvents; ///< since events were looked for
  bool IsLit = false;        ///< The button is, by this object.
  bool IsLooking = false;    ///< for events

  Q_DISABLE_COPY(pqAbortButtonBehavior)
};

#endif
