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
 * Lets the abort button in the status bar stop a run of Volumic's filters, with the built-in
 * server.
 *
 * During a run only this object updates the progress bar and processes events. The pause between
 * two updates is ten times the duration of the last one. ParaView 6.1 enables the button, too, but
 * rejects mouse presses. Earlier versions do not enable it and process no events.
 *
 * During a run the window accepts only a press of the button, because shortcuts and timers could
 * change the executing pipeline. Quitting or closing the window stops the run; the window closes
 * after it. Other input shows a message in the status bar.
 */
class pqAbortButtonBehavior : public QObject
{
  Q_OBJECT

public:
  pqAbortButtonBehavior();
  ~pqAbortButtonBehavior() override;

  /** ParaView calls these after loading the plugin, and at exit. */
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
  /** Return whether the event is a press of the button. */
  bool isPressOfButton(QObject* object, QEvent* event) const;

  QPointer<QAbstractButton> Button;
  vtkWeakPointer<vtkAlgorithm> Running;
  QElapsedTimer SinceUpdate;     ///< time since the last update of the window
  qint64 Pause = 0;              ///< until the next update, in milliseconds
  bool HasEnabledButton = false; ///< by this object
  bool IsUpdating = false;
  bool IsQuitting = false;

  Q_DISABLE_COPY(pqAbortButtonBehavior)
};

#endif
