// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "pqSummaryDecorator.h"

#include "LabelBelow.h"
#include "SurfaceSources.h"

#include <pqApplicationCore.h>
#include <pqPropertyWidget.h>
#include <pqServerManagerModel.h>

#include <vtkDataObject.h>
#include <vtkPVArrayInformation.h>
#include <vtkPVDataInformation.h>
#include <vtkSMOutputPort.h>
#include <vtkSMSourceProxy.h>

#include <QLabel>
#include <QStringList>

namespace
{
double NumberOf(vtkPVDataInformation* data, const char* name)
{
  vtkPVArrayInformation* array = data->GetArrayInformation(name, vtkDataObject::FIELD);
  return array ? array->GetComponentRange(0)[0] : 0.0;
}

QStringList TextsOf(vtkPVDataInformation* data, const char* name)
{
  vtkPVArrayInformation* array = data->GetArrayInformation(name, vtkDataObject::FIELD);
  QStringList texts;
  for (int i = 0; array && i < array->GetNumberOfStringValues(); ++i)
  {
    texts.append(QString::fromUtf8(array->GetStringValue(i)));
  }
  return texts;
}

/** Of blocks of labels. */
QString SummaryOfLabels(vtkPVDataInformation* data, const QString& why)
{
  const QStringList lost = TextsOf(data, "LostLabels");
  return (why.isEmpty() ? QObject::tr("<b>Surfaces</b>")
                        : QObject::tr("<b>Unfinished</b> (%1)").arg(why)) +
    QObject::tr(": %1 vertices<br>no self-intersections").arg(data->GetNumberOfPoints()) +
    (lost.isEmpty() ? QString() : "<br>" + lost.first().toHtmlEscaped());
}

QString SummaryOf(vtkPVDataInformation* data)
{
  if (!data->GetArrayInformation("StopReason", vtkDataObject::FIELD))
  {
    return QString();
  }
  const QString why = QString::fromStdString(volumic::WhyUnfinished(data));
  if (data->IsCompositeDataSet())
  {
    return SummaryOfLabels(data, why);
  }
  const bool isUnfinished = !why.isEmpty();
  const QString level = QString::number(NumberOf(data, "Level"));
  const QString head = isUnfinished
    ? QObject::tr("<b>Unfinished</b> (%1): level %2").arg(why, level)
    : QObject::tr("<b>Surface</b> of level %1").arg(level);
  if (data->GetNumberOfCells() == 0)
  {
    return isUnfinished ? QObject::tr("<b>Unfinished</b> (%1): no surface yet").arg(why)
                        : head + QObject::tr(": nothing is left");
  }
  const double parts = NumberOf(data, "NumberOfComponents");
  // Lines that the panel shows whole where it is narrow.
  return head +
    QObject::tr("<br>%1 vertices, %2 %3, genus %4<br>area %5 world units²<br>"
                "volume %6 world units³<br>%7 % of the boundary missing<br>no self-intersections")
      .arg(data->GetNumberOfPoints())
      .arg(parts)
      .arg(parts == 1.0 ? QObject::tr("part") : QObject::tr("parts"))
      .arg(NumberOf(data, "Genus"))
      .arg(NumberOf(data, "Area"))
      .arg(NumberOf(data, "Volume"))
      .arg(100.0 * NumberOf(data, "MissingBoundary"), 0, 'f', 1);
}
}

//------------------------------------------------------------------------------
pqSummaryDecorator::pqSummaryDecorator(vtkPVXMLElement* xml, pqPropertyWidget* parent)
  : pqPropertyWidgetDecorator(xml, parent)
  , Label(volumic::AddLabelBelow(parent, "Summary"))
{
  this->showSummary();
  this->connect(pqApplicationCore::instance()->getServerManagerModel(),
    SIGNAL(dataUpdated(pqPipelineSource*)), SLOT(showSummary()));
}

pqSummaryDecorator::~pqSummaryDecorator() = default;

//------------------------------------------------------------------------------
void pqSummaryDecorator::showSummary()
{
  auto* source = vtkSMSourceProxy::SafeDownCast(this->parentWidget()->proxy());
  const bool hasRun = source && source->GetOutputPortsCreated();
  const QString text =
    hasRun ? SummaryOf(source->GetOutputPort(0u)->GetDataInformation()) : QString();
  this->Label->setText(text);
  this->Label->setVisible(!text.isEmpty());
}
