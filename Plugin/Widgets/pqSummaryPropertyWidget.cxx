// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "pqSummaryPropertyWidget.h"

#include "SurfaceSources.h"

#include <pqApplicationCore.h>
#include <pqServerManagerModel.h>

#include <vtkDataObject.h>
#include <vtkPVArrayInformation.h>
#include <vtkPVDataInformation.h>
#include <vtkSMOutputPort.h>
#include <vtkSMPropertyHelper.h>
#include <vtkSMSourceProxy.h>

#include <QLabel>
#include <QLocale>
#include <QStringList>
#include <QVBoxLayout>

#include <cmath>

namespace
{
double NumberOf(vtkPVDataInformation* data, const char* name)
{
  vtkPVArrayInformation* array = data->GetArrayInformation(name, vtkDataObject::FIELD);
  return array ? array->GetComponentRange(0)[0] : 0.0;
}

QString TextOf(vtkPVDataInformation* data, const char* name)
{
  vtkPVArrayInformation* array = data->GetArrayInformation(name, vtkDataObject::FIELD);
  return array && array->GetNumberOfStringValues() > 0
    ? QString::fromUtf8(array->GetStringValue(0)).toHtmlEscaped()
    : QString();
}

/** Return the number with thousands separators. */
QString Count(double value)
{
  return QLocale(QLocale::English).toString(value, 'f', 0);
}

/** Return the number with three digits: 0.0123, 12.3, 1,230, 1.23 million. */
QString ThreeDigits(double value)
{
  const double size = std::abs(value);
  if (size >= 999.5e6)
  {
    return ThreeDigits(value / 1e9) + QObject::tr(" billion");
  }
  if (size >= 999.5e3)
  {
    return ThreeDigits(value / 1e6) + QObject::tr(" million");
  }
  const double unit = size < 1000.0 ? 1.0 : std::pow(10.0, std::floor(std::log10(size)) - 2.0);
  return size < 1000.0 ? QString::number(value, 'g', 3) : Count(std::round(value / unit) * unit);
}

QString UnitOf(vtkSMSourceProxy* filter)
{
  vtkSMOutputPort* input = vtkSMPropertyHelper(filter, "Input").GetAsOutputPort();
  const QString unit = input ? TextOf(input->GetDataInformation(), "LengthUnit") : QString();
  return unit.isEmpty() ? QObject::tr("world units") : unit;
}

QString SummaryOfLabels(vtkPVDataInformation* data, const QString& why)
{
  const QString lost = TextOf(data, "LostLabels");
  return (why.isEmpty() ? QObject::tr("<b>Surfaces</b>")
                        : QObject::tr("<b>Unfinished</b> (%1)").arg(why)) +
    QObject::tr(": %1 vertices<br>no self-intersections").arg(Count(data->GetNumberOfPoints())) +
    (lost.isEmpty() ? QString() : "<br>" + lost);
}

QString SummaryOf(vtkPVDataInformation* data, const QString& unit)
{
  if (!data->GetArrayInformation("StopReason", vtkDataObject::FIELD))
  {
    return QObject::tr("none yet");
  }
  const QString why = QString::fromStdString(volumic::UnfinishedReason(data));
  if (data->IsCompositeDataSet())
  {
    return SummaryOfLabels(data, why);
  }
  const bool isUnfinished = !why.isEmpty();
  const QString level = QString::number(NumberOf(data, "Level"));
  const QString head = isUnfinished
    ? QObject::tr("<b>Unfinished</b> (%1 at level %2)").arg(why, level)
    : QObject::tr("<b>Surface</b> of level %1, started at level %2")
        .arg(level, Count(NumberOf(data, "StartLevel")));
  if (data->GetNumberOfCells() == 0)
  {
    return isUnfinished ? QObject::tr("<b>Unfinished</b> (%1): no surface yet").arg(why)
                        : head + QObject::tr(": nothing is left");
  }
  const double parts = NumberOf(data, "NumberOfComponents");
  return head +
    QObject::tr("<br>%1 vertices, %2 %3, genus %4<br>area %5 %8²<br>volume %6 %8³<br>"
                "%7 % of the boundary missing<br>no self-intersections")
      .arg(Count(data->GetNumberOfPoints()), Count(parts),
        parts == 1.0 ? QObject::tr("component") : QObject::tr("components"),
        Count(NumberOf(data, "Genus")), ThreeDigits(NumberOf(data, "Area")),
        ThreeDigits(NumberOf(data, "Volume")),
        QString::number(100.0 * NumberOf(data, "MissingBoundary"), 'f', 1), unit);
}
}

//------------------------------------------------------------------------------
pqSummaryPropertyWidget::pqSummaryPropertyWidget(
  vtkSMProxy* proxy, vtkSMProperty* property, QWidget* parent)
  : pqPropertyWidget(proxy, parent), Label(new QLabel(this))
{
  this->setShowLabel(false);
  this->setProperty(property);
  this->Label->setObjectName("Summary");
  this->Label->setWordWrap(true);
  this->Label->setTextInteractionFlags(Qt::TextSelectableByMouse);
  auto* layout = new QVBoxLayout(this);
  layout->setContentsMargins(0, 0, 0, 0);
  layout->addWidget(this->Label);
  this->showSummary();
  this->connect(pqApplicationCore::instance()->getServerManagerModel(),
    SIGNAL(dataUpdated(pqPipelineSource*)), SLOT(showSummary()));
}

pqSummaryPropertyWidget::~pqSummaryPropertyWidget() = default;

//------------------------------------------------------------------------------
void pqSummaryPropertyWidget::showSummary()
{
  auto* source = vtkSMSourceProxy::SafeDownCast(this->proxy());
  const bool hasRun = source && source->GetOutputPortsCreated();
  this->Label->setText(hasRun
      ? SummaryOf(source->GetOutputPort(0u)->GetDataInformation(), UnitOf(source))
      : QObject::tr("none yet"));
}
