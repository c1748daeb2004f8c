// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "MaskFolder.h"

#include "LabelNames.h"
#include "Messages.h"
#include "ReadVolume.h"
#include "Texts.h"
#include "ToolErrors.h"

#include <vtkDataArray.h>
#include <vtkFieldData.h>
#include <vtkImageData.h>
#include <vtkPointData.h>
#include <vtkUnsignedShortArray.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <iterator>
#include <limits>
#include <map>
#include <memory>
#include <utility>

namespace tool
{
namespace
{
/** Without its folder and its suffix, which may have two parts. */
std::string NameOfMask(const std::string& file)
{
  const std::string name = std::filesystem::path(file).filename().string();
  for (const char* suffix :
    { ".nii.gz", ".nii", ".seg.nrrd", ".nrrd", ".nhdr", ".mha", ".mhd", ".vti", ".mgz" })
  {
    if (EndsWith(Lower(name), suffix))
    {
      return name.substr(0, name.size() - std::string(suffix).size());
    }
  }
  return "";
}

/** Whether both have the same voxels. */
bool LieAlike(vtkImageData* a, vtkImageData* b)
{
  return std::equal(a->GetExtent(), a->GetExtent() + 6, b->GetExtent()) &&
    PlacementOf(a).IsLike(PlacementOf(b), a->GetDimensions());
}

/** The map as it grows, mask by mask. */
class GrowingMap
{
public:
  explicit GrowingMap(vtkIdType voxels)
  {
    this->Labels->SetName("Labels");
    this->Labels->SetNumberOfTuples(voxels);
    this->Labels->FillValue(0);
  }

  /** @throws Failure if the values are none of a mask. */
  void Add(vtkDataArray* mask)
  {
    FailIf(mask->GetNumberOfComponents() != 1,
      "voxels of a mask have one number, not " + NumberText(mask->GetNumberOfComponents()));
    std::uint16_t* labels = this->Labels->GetPointer(0);
    const vtkIdType count = mask->GetNumberOfTuples();
    switch (mask->GetDataType())
    {
      vtkTemplateMacro(
        this->AddValues(static_cast<const VTK_TT*>(mask->GetVoidPointer(0)), count, labels));
      default:
        throw Failure("holds no numbers");
    }
  }

  vtkSmartPointer<vtkUnsignedShortArray> Labels = vtkSmartPointer<vtkUnsignedShortArray>::New();
  std::vector<vtkIdType> Sizes = { 0 };            ///< by label: of its mask
  std::map<std::pair<int, int>, vtkIdType> Shared; ///< by label: voxels of two masks

private:
  template <typename T>
  void AddValues(const T* values, vtkIdType count, std::uint16_t* labels)
  {
    constexpr double most = 0.01; // as labels are rounded
    double inside = 0.0;
    vtkIdType size = 0;
    for (vtkIdType i = 0; i < count; ++i)
    {
      const auto value = static_cast<double>(values[i]);
      if (std::abs(value) > most) // NaN is not.
      {
        inside = size++ == 0 ? value : inside;
        FailIf(!(std::abs(value - inside) <= most),
          "has the values " + NumberText(inside) + " and " + NumberText(value) +
            ": a mask has 0 and another one. Volumes of a folder, or of a file, are read as masks, "
            "one for each label; give a volume, or a label map, by its own name, or choose one of "
            "the file's with --time");
      }
    }
    this->Sizes.push_back(size);
    const auto own = static_cast<std::uint16_t>(this->Sizes.size() - 1);
    for (vtkIdType i = 0; i < count; ++i)
    {
      if (std::abs(static_cast<double>(values[i])) > most)
      {
        const std::uint16_t other = labels[i];
        if (other != 0)
        {
          ++this->Shared[{ other, own }];
        }
        labels[i] = other == 0 || size < this->Sizes[other] ? own : other;
      }
    }
  }
};

/** A mask that is read when its turn comes. */
struct Mask
{
  std::string Place; ///< what errors call it
  std::string Name;  ///< empty: it has none
  std::function<vtkSmartPointer<vtkImageData>()> Read;

  /** In messages. */
  std::string Called() const { return this->Name.empty() ? this->Place : this->Name; }
};

void TellOfShared(const GrowingMap& map, const std::vector<Mask>& masks)
{
  constexpr std::size_t most = 5;
  vtkIdType all = 0;
  std::string list;
  std::size_t pairs = 0;
  for (const auto& [labels, voxels] : map.Shared)
  {
    all += voxels;
    if (++pairs <= most)
    {
      list += (list.empty() ? "" : ", ") +
        masks[static_cast<std::size_t>(labels.first) - 1].Called() + " and " +
        masks[static_cast<std::size_t>(labels.second) - 1].Called() + " " + std::to_string(voxels);
    }
  }
  if (all > 0)
  {
    TellOfFile(std::to_string(all) + " times a voxel is in two masks (" + list +
      (pairs > most ? ", ..." : "") + "): it is taken for the smaller one's");
  }
}

/** Organs that were not found have such. */
void TellOfEmpty(const GrowingMap& map, const std::vector<Mask>& masks)
{
  std::string list;
  for (std::size_t label = 1; label < map.Sizes.size(); ++label)
  {
    list += map.Sizes[label] > 0 ? "" : (list.empty() ? "" : ", ") + masks[label - 1].Called();
  }
  if (!list.empty())
  {
    TellOfFile("masks without a voxel: " + list);
  }
}

vtkSmartPointer<vtkImageData> MapOf(const std::vector<Mask>& masks)
{
  FailIf(masks.size() > std::numeric_limits<std::uint16_t>::max(), "there are too many masks");
  vtkSmartPointer<vtkImageData> first;
  std::unique_ptr<GrowingMap> map;
  LabelNames names;
  for (const Mask& each : masks)
  {
    const vtkSmartPointer<vtkImageData> mask = each.Read();
    Named(each.Place,
      [&]
      {
        ChooseScalars(mask, "");
        first = first ? first : mask;
        map = map ? std::move(map) : std::make_unique<GrowingMap>(mask->GetNumberOfPoints());
        FailIf(!LieAlike(first, mask),
          "its voxels are not those of " + masks.front().Place + ", in number or place");
        map->Add(mask->GetPointData()->GetScalars());
      });
    if (!each.Name.empty())
    {
      names.push_back({ static_cast<int>(map->Sizes.size()) - 1, each.Name });
    }
  }
  TellOfShared(*map, masks);
  TellOfEmpty(*map, masks);
  auto image = vtkSmartPointer<vtkImageData>::New();
  image->CopyStructure(first);
  image->GetFieldData()->ShallowCopy(first->GetFieldData());
  image->GetPointData()->SetScalars(map->Labels);
  SetLabelNames(image, names);
  return image;
}
}

std::vector<std::string> MasksAmong(const std::vector<std::string>& files)
{
  std::vector<std::string> masks;
  std::copy_if(files.begin(), files.end(), std::back_inserter(masks),
    [](const std::string& file) { return !NameOfMask(file).empty(); });
  std::sort(masks.begin(), masks.end());
  return masks;
}

vtkSmartPointer<vtkImageData> ReadMasks(
  const std::vector<std::string>& files, const VolumeChoice& all)
{
  VolumeChoice choice; // The rest of it is that of the folder.
  choice.AreLabels = true;
  choice.Resamples = all.Resamples;
  std::vector<Mask> masks;
  for (const std::string& file : files)
  {
    masks.push_back(
      { file, PlainName(NameOfMask(file)), [file, choice] { return ReadVolume(file, choice); } });
  }
  return MapOf(masks);
}

vtkSmartPointer<vtkImageData> ReadMasksOf(
  const std::string& file, vtkImageData* first, int count, VolumeChoice choice)
{
  std::vector<Mask> masks = { { "volume 0", "", [first] { return first; } } };
  for (int time = 1; time < count; ++time)
  {
    choice.Time = time;
    masks.push_back({ "volume " + std::to_string(time), "",
      [file, choice] { return ReadVolume(file, choice); } });
  }
  return MapOf(masks);
}
}
