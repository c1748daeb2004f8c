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
 * During a run this object alone updates the progress bar and processes events, in pauses that are
 * ten times the duration of the last update. ParaView 6.1 lights up the button, too, but rejects all
 * presses of the mouse. Earlier versions leave the button grey and process no events.
 *
 * During a run the window accepts only a press of that button: what shortcuts and timers start would
 * change a pipeline that is executing. To quit or to close the window stops the run. The window closes
 * after it. Other input shows a message in the status bar.
 *
 * This works with the built-in server only. Other servers run outside the window's reach.
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

Q_SIGNALS:
  /** Text and per cent for ParaView's progress bar. */
  void progress(const QString& text, int percent);

protected:
  bool eventFilter(QObject* object, QEvent* event) override;

private Q_SLOTS:
  void watch(pqPipelineSource* source);
  void onStart(vtkObject* filter);
  void onProgress();
  void onEnd();
  void stop();
  /** Close all windows as soon as the pipeline has finished. */
  void quit();

private:
  /** Return whether the event is a press of the button, on its way there. */
  bool isPressOfButton(QObject* object, QEvent* event) const;

  QPointer<QAbstractButton> Button;
  vtkWeakPointer<vtkAlgorithm> Running;
  QElapsedTimer SinceUpdate; ///< since the window was updated
  qint64 Pause = 0;          ///< until the next update, in milliseconds
  bool IsLit = false;        ///< This object has lit up the button.
  bool IsUpdating = false;
  bool IsQuitting = false;

  Q_DISABLE_COPY(pqAbortButtonBehavior)
};

#endif
