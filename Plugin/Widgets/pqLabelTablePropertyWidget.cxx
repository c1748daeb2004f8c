// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "pqLabelTablePropertyWidget.h"

#include <pqCoreUtilities.h>

#include <vtkCommand.h>
#include <vtkSMLabelsDomain.h>
#include <vtkSMProperty.h>
#include <vtkSMProxy.h>
#include <vtkSMUncheckedPropertyHelper.h>

#include <QColor>
#include <QGridLayout>
#include <QHeaderView>
#include <QIcon>
#include <QLabel>
#include <QLineEdit>
#include <QPixmap>
#include <QPushButton>
#include <QSet>
#include <QSignalBlocker>
#include <QTreeWidget>

#include <algorithm>
#include <array>
#include <initializer_list>

namespace
{
enum Column
{
  Name,
  Label,
  Voxels,
  NumberOfColumns
};

/** Columns of numbers are sorted as numbers. */
class Row : public QTreeWidgetItem
{
public:
  Row(const QString& name, int label, qlonglong voxels)
    : QTreeWidgetItem(Type)
  {
    this->setFlags(Qt::ItemIsEnabled | Qt::ItemIsSelectable | Qt::ItemIsUserCheckable);
    this->setText(Column::Name, name);
    this->setData(Column::Label, Qt::DisplayRole, label);
    this->setData(Column::Voxels, Qt::DisplayRole, voxels);
    for (int column : { Column::Label, Column::Voxels })
    {
      this->setTextAlignment(column, Qt::AlignRight | Qt::AlignVCenter);
    }
    this->setCheckState(Column::Name, Qt::Unchecked);
  }

  static constexpr int Type = QTreeWidgetItem::UserType;

  bool operator<(const QTreeWidgetItem& other) const override
  {
    const int column = this->treeWidget()->sortColumn();
    return column == Column::Name
      ? this->text(column).localeAwareCompare(other.text(column)) < 0
      : this->data(column, Qt::DisplayRole).toLongLong() <
        other.data(column, Qt::DisplayRole).toLongLong();
  }
};

int labelOf(const QTreeWidgetItem* row)
{
  return row->data(Column::Label, Qt::DisplayRole).toInt();
}

QIcon swatch(const std::array<double, 3>& color)
{
  QPixmap pixmap(12, 12);
  pixmap.fill(QColor::fromRgbF(color[0], color[1], color[2]));
  return QIcon(pixmap);
}

QList<QTreeWidgetItem*> rowsOf(const QTreeWidget* table)
{
  QList<QTreeWidgetItem*> rows;
  for (int i = 0; i < table->topLevelItemCount(); ++i)
  {
    rows << table->topLevelItem(i);
  }
  return rows;
}
}

//------------------------------------------------------------------------------
struct pqLabelTablePropertyWidget::Internals
{
  QLineEdit* Filter = nullptr;
  QTreeWidget* Table = nullptr;
  QPushButton* All = nullptr;
  QPushButton* None = nullptr;
  QLabel* Note = nullptr;
  vtkSMLabelsDomain* Domain = nullptr;
  QList<QVariant> Labels;
  QString Problem; ///< why there are no labels
};

//------------------------------------------------------------------------------
pqLabelTablePropertyWidget::pqLabelTablePropertyWidget(
  vtkSMProxy* proxy, vtkSMProperty* property, QWidget* parent)
  : Superclass(proxy, parent)
  , Parts(new Internals)
{
  this->setProperty(property);
  this->setShowLabel(false);
  this->setChangeAvailableAsChangeFinished(true);
  this->Parts->Domain = property->FindDomain<vtkSMLabelsDomain>();
  this->buildPanel();
  this->fillTable();
  this->addPropertyLink(this, "labels", SIGNAL(labelsChanged()), property);
  pqCoreUtilities::connect(property, vtkCommand::DomainModifiedEvent, this, SLOT(fillTable()));
  if (vtkSMProperty* background = proxy->GetProperty("BackgroundLabel"))
  {
    for (const vtkCommand::EventIds event :
      { vtkCommand::ModifiedEvent, vtkCommand::UncheckedPropertyModifiedEvent })
    {
      pqCoreUtilities::connect(background, event, this, SLOT(checkRows()));
    }
  }
}

pqLabelTablePropertyWidget::~pqLabelTablePropertyWidget() = default;

//------------------------------------------------------------------------------
void pqLabelTablePropertyWidget::buildPanel()
{
  Internals& parts = *this->Parts;
  auto* grid = new QGridLayout(this);
  grid->setContentsMargins(0, 0, 0, 0);
  grid->setVerticalSpacing(3);
  grid->addWidget(new QLabel(this->property()->GetXMLLabel(), this), 0, 0);
  parts.Filter = new QLineEdit(this);
  parts.Filter->setObjectName("Filter");
  parts.Filter->setPlaceholderText(tr("Search"));
  parts.Filter->setClearButtonEnabled(true);
  grid->addWidget(parts.Filter, 0, 1, 1, 2);

  parts.Table = new QTreeWidget(this);
  parts.Table->setObjectName("Labels");
  parts.Table->setColumnCount(Column::NumberOfColumns);
  parts.Table->setHeaderLabels({ tr("Name"), tr("Label"), tr("Voxels") });
  parts.Table->setRootIsDecorated(false);
  parts.Table->setUniformRowHeights(true);
  parts.Table->setSelectionMode(QAbstractItemView::ExtendedSelection);
  parts.Table->header()->setStretchLastSection(false);
  parts.Table->header()->setSectionResizeMode(Column::Name, QHeaderView::Stretch);
  parts.Table->header()->setSectionResizeMode(Column::Label, QHeaderView::ResizeToContents);
  parts.Table->header()->setSectionResizeMode(Column::Voxels, QHeaderView::ResizeToContents);
  parts.Table->sortByColumn(Column::Label, Qt::AscendingOrder);
  parts.Table->setSortingEnabled(true);
  parts.Table->setMinimumHeight(10 * parts.Table->fontMetrics().height());
  parts.Table->setMaximumHeight(14 * parts.Table->fontMetrics().height());
  grid->addWidget(parts.Table, 1, 0, 1, -1);

  parts.All = new QPushButton(tr("All"), this);
  parts.All->setObjectName("All");
  parts.None = new QPushButton(tr("None"), this);
  parts.None->setObjectName("None");
  grid->addWidget(parts.All, 2, 0);
  grid->addWidget(parts.None, 2, 1);
  grid->setColumnStretch(2, 1);
  parts.Note = new QLabel(this);
  parts.Note->setObjectName("Note");
  parts.Note->setWordWrap(true);
  grid->addWidget(parts.Note, 3, 0, 1, -1);

  this->connect(parts.Filter, SIGNAL(textChanged(const QString&)),
    SLOT(filterRows(const QString&)));
  this->connect(parts.Table, SIGNAL(itemChanged(QTreeWidgetItem*, int)),
    SLOT(readRow(QTreeWidgetItem*, int)));
  this->connect(parts.All, SIGNAL(clicked()), SLOT(checkAll()));
  this->connect(parts.None, SIGNAL(clicked()), SLOT(checkNone()));
}

//------------------------------------------------------------------------------
void pqLabelTablePropertyWidget::fillTable()
{
  Internals& parts = *this->Parts;
  const volumic::LabelRows labels =
    parts.Domain ? parts.Domain->GetLabels() : volumic::LabelRows();
  parts.Problem = QString::fromStdString(labels.Problem);
  {
    const QSignalBlocker blocker(parts.Table);
    parts.Table->setSortingEnabled(false);
    parts.Table->clear();
    for (const volumic::LabelRow& label : labels.Rows)
    {
      auto* row = new Row(QString::fromStdString(label.Name), label.Label, label.Voxels);
      row->setIcon(Column::Name, swatch(label.Color));
      row->setToolTip(Column::Name, row->text(Column::Name));
      parts.Table->addTopLevelItem(row);
    }
    parts.Table->setSortingEnabled(true);
  }
  this->checkRows();
}

//------------------------------------------------------------------------------
bool pqLabelTablePropertyWidget::isBackground(int label) const
{
  vtkSMProperty* background = this->proxy()->GetProperty("BackgroundLabel");
  return background && vtkSMUncheckedPropertyHelper(background).GetAsInt() == label;
}

//------------------------------------------------------------------------------
void pqLabelTablePropertyWidget::checkRows()
{
  Internals& parts = *this->Parts;
  {
    const QSignalBlocker blocker(parts.Table);
    QSet<int> listed;
    for (const QVariant& label : parts.Labels)
    {
      listed << label.toInt();
    }
    QSet<int> known;
    for (QTreeWidgetItem* row : rowsOf(parts.Table))
    {
      const int label = labelOf(row);
      if (row->data(Column::Voxels, Qt::DisplayRole).toLongLong() == 0 && !listed.contains(label))
      {
        delete row; // One that the input has not, and nobody asks for any longer.
        continue;
      }
      known << label;
      const bool isChecked = listed.isEmpty() ? !this->isBackground(label) : listed.contains(label);
      row->setCheckState(Column::Name, isChecked ? Qt::Checked : Qt::Unchecked);
    }
    for (int label : listed - known)
    {
      auto* row = new Row(tr("not in the input"), label, 0);
      row->setCheckState(Column::Name, Qt::Checked);
      parts.Table->addTopLevelItem(row);
    }
  }
  this->filterRows(parts.Filter->text());
  this->showNote();
}

//------------------------------------------------------------------------------
void pqLabelTablePropertyWidget::filterRows(const QString& text)
{
  for (QTreeWidgetItem* row : rowsOf(this->Parts->Table))
  {
    row->setHidden(!row->text(Column::Name).contains(text, Qt::CaseInsensitive) &&
      row->text(Column::Label) != text);
  }
}

//------------------------------------------------------------------------------
void pqLabelTablePropertyWidget::showNote()
{
  const Internals& parts = *this->Parts;
  int checked = 0;
  for (const QTreeWidgetItem* row : rowsOf(parts.Table))
  {
    checked += row->checkState(Column::Name) == Qt::Checked ? 1 : 0;
  }
  const int count = parts.Table->topLevelItemCount();
  for (QWidget* widget : std::initializer_list<QWidget*>{
         parts.Filter, parts.Table, parts.All, parts.None })
  {
    widget->setVisible(count > 0);
  }
  parts.Note->setText(count == 0 ? parts.Problem
      : checked == 0
      ? tr("<b>Note:</b> Where none is checked, all but the background get a surface.")
      : tr("%1 of %2 labels").arg(checked).arg(count));
  parts.Note->setVisible(!parts.Note->text().isEmpty());
}

//------------------------------------------------------------------------------
QList<QVariant> pqLabelTablePropertyWidget::labels() const
{
  return this->Parts->Labels;
}

void pqLabelTablePropertyWidget::setLabels(const QList<QVariant>& labels)
{
  if (labels != this->Parts->Labels)
  {
    this->Parts->Labels = labels;
    this->checkRows();
    Q_EMIT this->labelsChanged();
  }
}

//------------------------------------------------------------------------------
void pqLabelTablePropertyWidget::readTable()
{
  QList<int> checked;
  bool isDefault = true;
  for (const QTreeWidgetItem* row : rowsOf(this->Parts->Table))
  {
    const bool isChecked = row->checkState(Column::Name) == Qt::Checked;
    isDefault = isDefault && isChecked != this->isBackground(labelOf(row));
    if (isChecked)
    {
      checked << labelOf(row);
    }
  }
  std::sort(checked.begin(), checked.end());
  QList<QVariant> labels;
  for (int i = 0; !isDefault && i < checked.size(); ++i)
  {
    labels << checked[i];
  }
  this->showNote();
  if (labels != this->Parts->Labels)
  {
    this->Parts->Labels = labels;
    Q_EMIT this->labelsChanged();
  }
}

//------------------------------------------------------------------------------
void pqLabelTablePropertyWidget::checkShownRows(bool yes)
{
  {
    const QSignalBlocker blocker(this->Parts->Table);
    for (QTreeWidgetItem* row : rowsOf(this->Parts->Table))
    {
      if (!row->isHidden())
      {
        const bool isChecked = yes && !this->isBackground(labelOf(row));
        row->setCheckState(Column::Name, isChecked ? Qt::Checked : Qt::Unchecked);
      }
    }
  }
  this->readTable();
}

void pqLabelTablePropertyWidget::checkAll()
{
  this->checkShownRows(true);
}

void pqLabelTablePropertyWidget::checkNone()
{
  this->checkShownRows(false);
}

//------------------------------------------------------------------------------
void pqLabelTablePropertyWidget::readRow(QTreeWidgetItem* row, int column)
{
  if (column != Column::Name)
  {
    return;
  }
  if (row->isSelected())
  {
    const QSignalBlocker blocker(this->Parts->Table);
    for (QTreeWidgetItem* other : this->Parts->Table->selectedItems())
    {
      other->setCheckState(Column::Name, row->checkState(Column::Name));
    }
  }
  this->readTable();
}
