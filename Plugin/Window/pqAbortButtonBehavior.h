// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef pqAbortButtonBehavior_h
#define pqAbortButtonBehavior_h

#include <QObject>
#include <QPointer>

class QAbstractButton;

/**
 * Lets a press of the abort button in ParaView's status bar through, which then stops a run.
 *
 * While something runs, ParaView 6.1 lights the button up and swallows presses of the mouse, but for
 * those on objects that it has on a list. The button is on it; the window, which gets each press
 * first and hands it on, is not. Here it is, as long as the mouse is on the button. A press that
 * misses the button is still swallowed, by the widget that it is handed on to.
 */
class pqAbortButtonBehavior : public QObject
{
  Q_OBJECT

public:
  pqAbortButtonBehavior();
  ~pqAbortButtonBehavior() override;

  /// Called by ParaView when it has loaded the plugin, and when it ends.
  void startup();
  void shutdown();

protected:
  bool eventFilter(QObject* object, QEvent* event) override;

private Q_SLOTS:
  /// Looks for the button, which may come after the plugin.
  void findButton();

private:
  void letThrough(bool yes);

  QPointer<QAbstractButton> Button;

  Q_DISABLE_COPY(pqAbortButtonBehavior)
};

#endif
