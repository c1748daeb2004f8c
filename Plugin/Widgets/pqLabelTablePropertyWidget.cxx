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
#include <QSortFilterProxyModel>
#include <QStandardItemModel>
#include <QTreeView>

#include <algorithm>
#include <array>

namespace
{
enum Column
{
  Name,
  Label,
  Voxels,
  NumberOfColumns
};
constexpr int SearchRole = Qt::UserRole;
constexpr int InInputRole = Qt::UserRole + 1;

QIcon swatch(const std::array<double, 3>& color)
{
  QPixmap pixmap(12, 12);
  pixmap.fill(QColor::fromRgbF(color[0], color[1], color[2]));
  return QIcon(pixmap);
}

/** Return an item that is sorted by its number. */
QStandardItem* numberItem(qlonglong number)
{
  auto* item = new QStandardItem;
  item->setData(number, Qt::DisplayRole);
  item->setTextAlignment(Qt::AlignRight | Qt::AlignVCenter);
  item->setEditable(false);
  return item;
}

QList<QStandardItem*> newRow(const QString& name, int label, qlonglong voxels)
{
  auto* item = new QStandardItem(name);
  item->setData(name + '\n' + QString::number(label), SearchRole);
  item->setData(voxels > 0, InInputRole);
  item->setToolTip(name);
  item->setEditable(false);
  item->setCheckable(true);
  return { item, numberItem(label), numberItem(voxels) };
}
}

//------------------------------------------------------------------------------
struct pqLabelTablePropertyWidget::Internals
{
  QStandardItemModel Rows;
  QSortFilterProxyModel Shown; ///< rows that Search leaves
  QLineEdit* Filter = nullptr;
  QTreeView* Table = nullptr;
  QPushButton* All = nullptr;
  QPushButton* OnlyThese = nullptr;
  QLabel* Note = nullptr;
  vtkSMLabelsDomain* Domain = nullptr;
  QList<QVariant> Labels;
  QString Problem; ///< error message if there are no labels

  bool IsChecking = false; ///< this widget sets the boxes

  int labelOf(int row) const
  {
    return this->Rows.item(row, Column::Label)->data(Qt::DisplayRole).toInt();
  }

  void check(int row, bool yes)
  {
    this->Rows.item(row)->setCheckState(yes ? Qt::Checked : Qt::Unchecked);
  }

  bool isChecked(int row) const { return this->Rows.item(row)->checkState() == Qt::Checked; }

  QList<int> checked() const
  {
    QList<int> labels;
    for (int row = 0; row < this->Rows.rowCount(); ++row)
    {
      if (this->isChecked(row))
      {
        labels << this->labelOf(row);
      }
    }
    return labels;
  }

  QModelIndexList selected() const { return this->Table->selectionModel()->selectedRows(); }

  /** Return the rows that Search leaves. */
  QModelIndexList found() const
  {
    QModelIndexList rows;
    for (int row = 0; row < this->Shown.rowCount(); ++row)
    {
      rows << this->Shown.index(row, Column::Name);
    }
    return rows;
  }

  void check(const QModelIndexList& rows, Qt::CheckState state)
  {
    for (const QModelIndex& row : rows)
    {
      this->Shown.setData(row, state, Qt::CheckStateRole);
    }
  }
};

//------------------------------------------------------------------------------
pqLabelTablePropertyWidget::pqLabelTablePropertyWidget(
  vtkSMProxy* proxy, vtkSMProperty* property, QWidget* parent)
  : Superclass(proxy, parent), Parts(new Internals)
{
  this->setProperty(property);
  this->setShowLabel(false);
  this->setChangeAvailableAsChangeFinished(true);
  this->Parts->Domain = property->FindDomain<vtkSMLabelsDomain>();
  this->buildPanel();
  this->fillTable();
  this->addPropertyLink(this, "labels", SIGNAL(labelsChanged()), property);
  pqCoreUtilities::connect(property, vtkCommand::DomainModifiedEvent, this, SLOT(fillTable()));
  vtkSMProperty* background = proxy->GetProperty("BackgroundLabel");
  for (const vtkCommand::EventIds event :
    { vtkCommand::ModifiedEvent, vtkCommand::UncheckedPropertyModifiedEvent })
  {
    pqCoreUtilities::connect(background, event, this, SLOT(checkRows()));
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

  parts.Rows.setHorizontalHeaderLabels({ tr("Name"), tr("Label"), tr("Voxels") });
  parts.Shown.setSourceModel(&parts.Rows);
  parts.Shown.setFilterCaseSensitivity(Qt::CaseInsensitive);
  parts.Shown.setFilterRole(SearchRole);
  parts.Shown.setSortLocaleAware(true);
  parts.Table = new QTreeView(this);
  parts.Table->setObjectName("Labels");
  parts.Table->setModel(&parts.Shown);
  parts.Table->setRootIsDecorated(false);
  parts.Table->setUniformRowHeights(true);
  parts.Table->setTextElideMode(Qt::ElideMiddle);
  parts.Table->setSelectionMode(QAbstractItemView::ExtendedSelection);
  parts.Table->header()->setStretchLastSection(false);
  parts.Table->header()->setSectionResizeMode(QHeaderView::ResizeToContents);
  parts.Table->header()->setSectionResizeMode(Column::Name, QHeaderView::Stretch);
  parts.Table->sortByColumn(Column::Label, Qt::AscendingOrder);
  parts.Table->setSortingEnabled(true);
  parts.Table->setMinimumHeight(10 * parts.Table->fontMetrics().height());
  parts.Table->setMaximumHeight(14 * parts.Table->fontMetrics().height());
  grid->addWidget(parts.Table, 1, 0, 1, -1);

  parts.All = new QPushButton(tr("All"), this);
  parts.All->setObjectName("All");
  parts.All->setToolTip(tr("Check the rows that Search leaves, too."));
  parts.OnlyThese = new QPushButton(tr("Only These"), this);
  parts.OnlyThese->setObjectName("OnlyThese");
  parts.OnlyThese->setToolTip(tr("Check only the selected rows, or else only the rows that Search "
                                 "leaves. Select rows or type into Search first."));
  grid->addWidget(parts.All, 2, 0);
  grid->addWidget(parts.OnlyThese, 2, 1);
  grid->setColumnStretch(2, 1);
  parts.Note = new QLabel(this);
  parts.Note->setObjectName("Note");
  parts.Note->setWordWrap(true);
  grid->addWidget(parts.Note, 3, 0, 1, -1);

  this->connect(parts.Filter, SIGNAL(textChanged(const QString&)), SLOT(search(const QString&)));
  this->connect(parts.Table->selectionModel(),
    SIGNAL(selectionChanged(const QItemSelection&, const QItemSelection&)), SLOT(showNote()));
  this->connect(&parts.Rows, SIGNAL(itemChanged(QStandardItem*)), SLOT(readRow(QStandardItem*)));
  this->connect(parts.All, SIGNAL(clicked()), SLOT(checkAll()));
  this->connect(parts.OnlyThese, SIGNAL(clicked()), SLOT(checkOnlyThese()));
}

//------------------------------------------------------------------------------
void pqLabelTablePropertyWidget::fillTable()
{
  Internals& parts = *this->Parts;
  const volumic::LabelRows labels = parts.Domain->GetLabels();
  parts.Problem = QString::fromStdString(labels.Problem);
  parts.IsChecking = true;
  parts.Rows.removeRows(0, parts.Rows.rowCount());
  for (const volumic::LabelRow& label : labels.Rows)
  {
    const auto row = newRow(QString::fromStdString(label.Name), label.Label, label.Voxels);
    row[Column::Name]->setIcon(swatch(label.Color));
    parts.Rows.appendRow(row);
  }
  this->checkRows();
}

//------------------------------------------------------------------------------
bool pqLabelTablePropertyWidget::isBackground(int label) const
{
  return vtkSMUncheckedPropertyHelper(this->proxy(), "BackgroundLabel").GetAsInt() == label;
}

//------------------------------------------------------------------------------
void pqLabelTablePropertyWidget::checkRows()
{
  Internals& parts = *this->Parts;
  parts.IsChecking = true;
  QSet<int> listed;
  for (const QVariant& label : parts.Labels)
  {
    listed << label.toInt();
  }
  QSet<int> unknown = listed;
  for (int row = parts.Rows.rowCount() - 1; row >= 0; --row)
  {
    const int label = parts.labelOf(row);
    if (!parts.Rows.item(row)->data(InInputRole).toBool() && !listed.contains(label))
    {
      parts.Rows.removeRow(row); // A label that the input does not have.
      continue;
    }
    parts.check(row, listed.isEmpty() ? !this->isBackground(label) : listed.contains(label));
    unknown.remove(label);
  }
  for (int label : unknown)
  {
    parts.Rows.appendRow(newRow(tr("not in the input"), label, 0));
    parts.check(parts.Rows.rowCount() - 1, true);
  }
  parts.IsChecking = false;
  this->showNote();
}

//------------------------------------------------------------------------------
void pqLabelTablePropertyWidget::showNote()
{
  const Internals& parts = *this->Parts;
  const int count = parts.Rows.rowCount();
  for (QWidget* widget : { static_cast<QWidget*>(parts.Filter), static_cast<QWidget*>(parts.Table),
         static_cast<QWidget*>(parts.All), static_cast<QWidget*>(parts.OnlyThese) })
  {
    widget->setVisible(count > 0);
  }
  parts.Note->setText(
    count == 0 ? parts.Problem : tr("%1 of %2 labels").arg(parts.checked().size()).arg(count));
  parts.Note->setVisible(!parts.Note->text().isEmpty());
  parts.OnlyThese->setEnabled(
    !parts.Filter->text().isEmpty() || parts.Table->selectionModel()->hasSelection());
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
  Internals& parts = *this->Parts;
  parts.IsChecking = false;
  QList<int> checked = parts.checked();
  if (checked.isEmpty())
  {
    // An empty list means all.
    this->checkRows();
    parts.Note->setText(tr("<b>Note:</b> At least one label must be checked."));
    return;
  }
  bool isDefault = true;
  for (int row = 0; row < parts.Rows.rowCount(); ++row)
  {
    const int label = parts.labelOf(row);
    isDefault = isDefault && checked.contains(label) != this->isBackground(label);
  }
  std::sort(checked.begin(), checked.end());
  QList<QVariant> labels;
  for (int i = 0; !isDefault && i < checked.size(); ++i)
  {
    labels << checked[i];
  }
  this->showNote();
  if (labels != parts.Labels)
  {
    parts.Labels = labels;
    Q_EMIT this->labelsChanged();
  }
}

//------------------------------------------------------------------------------
void pqLabelTablePropertyWidget::search(const QString& text)
{
  this->Parts->Table->clearSelection();
  this->Parts->Shown.setFilterFixedString(text);
  this->showNote();
}

//------------------------------------------------------------------------------
void pqLabelTablePropertyWidget::checkAll()
{
  Internals& parts = *this->Parts;
  parts.IsChecking = true;
  for (const QModelIndex& index : parts.found())
  {
    const int row = parts.Shown.mapToSource(index).row();
    parts.check(row, !this->isBackground(parts.labelOf(row)));
  }
  this->readTable();
}

//------------------------------------------------------------------------------
void pqLabelTablePropertyWidget::checkOnlyThese()
{
  Internals& parts = *this->Parts;
  parts.IsChecking = true;
  for (int row = 0; row < parts.Rows.rowCount(); ++row)
  {
    parts.check(row, false);
  }
  parts.check(parts.selected().isEmpty() ? parts.found() : parts.selected(), Qt::Checked);
  this->readTable();
}

//------------------------------------------------------------------------------
void pqLabelTablePropertyWidget::readRow(QStandardItem* item)
{
  Internals& parts = *this->Parts;
  if (!parts.IsChecking)
  {
    parts.IsChecking = true;
    if (parts.selected().contains(parts.Shown.mapFromSource(item->index())))
    {
      parts.check(parts.selected(), item->checkState());
    }
    this->readTable();
  }
}
