# SPDX-FileCopyrightText: Copyright (c) Volumic contributors
# SPDX-License-Identifier: BSD-3-Clause

# Widgets and behaviors of ParaView's window, if ParaView has one: sets volumic_window_interfaces and
# volumic_window_sources for paraview_add_plugin.
set(volumic_window_interfaces)
set(volumic_window_sources)

# volumic_panel_widget(KIND TYPE CLASS): TYPE is the name in the XML of the proxies.
function (volumic_panel_widget kind type class)
  paraview_plugin_add_property_widget(
    KIND "${kind}"
    TYPE "${type}"
    CLASS_NAME "${class}"
    INTERFACES interfaces
    SOURCES sources)
  set(volumic_window_interfaces ${volumic_window_interfaces} ${interfaces} PARENT_SCOPE)
  set(volumic_window_sources ${volumic_window_sources} ${sources}
    "Widgets/${class}.cxx" "Widgets/${class}.h" PARENT_SCOPE)
endfunction ()

if (PARAVIEW_USE_QT)
  volumic_panel_widget(WIDGET Summary pqSummaryPropertyWidget)
  volumic_panel_widget(WIDGET_DECORATOR ValueRange pqValueRangeDecorator)
  volumic_panel_widget(WIDGET LabelTable pqLabelTablePropertyWidget)
  volumic_panel_widget(WIDGET PointList pqPointListPropertyWidget)
  list(APPEND volumic_window_sources
    Widgets/HistogramWidget.cxx Widgets/HistogramWidget.h
    Widgets/LabelBelow.cxx Widgets/LabelBelow.h
    Window/SurfaceSources.cxx Window/SurfaceSources.h)

  set(volumic_behaviors
    pqAbortButtonBehavior pqLabelLegendBehavior pqUnfinishedBehavior)
  foreach (behavior IN LISTS volumic_behaviors)
    paraview_plugin_add_auto_start(
      CLASS_NAME "${behavior}"
      INTERFACES interfaces
      SOURCES sources)
    list(APPEND volumic_window_interfaces ${interfaces})
    list(APPEND volumic_window_sources ${sources}
      "Window/${behavior}.cxx" "Window/${behavior}.h")
  endforeach ()
endif ()
