// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause

// The same surfaces whatever the number of ranks and threads and the limit of memory, for all
// settings that change what ranks share, and all kinds of voxels.
#include "PieceSource.h"
#include "RankOutputTestTools.h"
#include "TemporaryFolder.h"
#include "vtkImagePyramid.h"

#include <vtkErrorCode.h>
#include <vtkFloatArray.h>

using namespace volumic;

namespace
{
vtkSmartPointer<vtkImageData> ByteVoxels()
{
  return TwoBalls();
}

/** NaN outside a cylinder, as of a scanner, and here and there in and about the object. */
vtkSmartPointer<vtkImageData> VoxelsWithNaNs()
{
  const auto image = TwoBalls();
  vtkNew<vtkFloatArray> voxels;
  voxels->DeepCopy(image->GetPointData()->GetScalars());
  std::mt19937 generator(3);
  for (vtkIdType v = 0; v < voxels->GetNumberOfTuples(); ++v)
  {
    const double x = static_cast<double>(v % SharedSize) - 70.0;
    const double y = static_cast<double>(v / SharedSize % SharedSize) - 70.0;
    if (std::hypot(x, y) > 65.0 || generator() % 500 == 0)
    {
      voxels->SetValue(v, std::numeric_limits<float>::quiet_NaN());
    }
  }
  image->GetPointData()->SetScalars(voxels);
  return image;
}

vtkSmartPointer<vtkUnsignedCharArray> Ghosts(vtkIdType count)
{
  auto ghosts = vtkSmartPointer<vtkUnsignedCharArray>::New();
  ghosts->SetName(vtkDataSetAttributes::GhostArrayName());
  ghosts->SetNumberOfTuples(count);
  ghosts->Fill(0.0);
  return ghosts;
}

/** A part of the large ball is hidden: its background is less than any byte. */
vtkSmartPointer<vtkImageData> HiddenPoints()
{
  const auto image = TwoBalls();
  const auto ghosts = Ghosts(image->GetNumberOfPoints());
  for (vtkIdType v = 0; v < ghosts->GetNumberOfTuples(); ++v)
  {
    ghosts->SetValue(v, v % SharedSize > 78 ? vtkDataSetAttributes::HIDDENPOINT : 0);
  }
  image->GetPointData()->AddArray(ghosts);
  return image;
}

vtkSmartPointer<vtkImageData> HiddenCells()
{
  const auto image = TwoBalls();
  const auto ghosts = Ghosts(image->GetNumberOfCells());
  const vtkIdType slice = (SharedSize - 1) * (SharedSize - 1);
  for (vtkIdType c = 0; c < ghosts->GetNumberOfTuples(); ++c)
  {
    // About the border of two pieces: what a cell hides depends on those of other ranks.
    ghosts->SetValue(c, c / slice >= 76 && c / slice < 84 && c % 160 < 70
        ? vtkDataSetAttributes::HIDDENCELL
        : 0);
  }
  image->GetCellData()->AddArray(ghosts);
  return image;
}

/** A plate of two voxels, as only the image shows it, between two pieces. */
vtkSmartPointer<vtkImageData> Plate()
{
  const auto image = TwoBalls();
  image->GetPointData()->GetScalars()->Fill(0.0);
  for (int k = 80; k < 82; ++k)
  {
    for (int j = 40; j < 120; ++j)
    {
      for (int i = 40; i < 120; ++i)
      {
        image->SetScalarComponentFromDouble(i, j, k, 0, 100.0);
      }
    }
  }
  return image;
}

struct Case
{
  const char* Name;
  Choice Set;
  vtkSmartPointer<vtkImageData> (*Make)() = ByteVoxels;
  const char* Told = ""; ///< why the first process is alone
  bool HasCheckpoints = false;
  bool IsChosenInPieces = false;
};

std::ostream& operator<<(std::ostream& out, const Case& c)
{
  return out << c.Name;
}

/** @param place by default in the smaller ball, which has not the volume of a large component */
Case OfComponents(const char* name, vtkDeformableSurface::KeepComponentsType kind,
  const std::array<double, 3>& place = { 108.0, 106.0, 104.0 })
{
  Case of = { name };
  of.Set = [kind, place](vtkDeformableSurface* f)
  {
    f->SetKeepComponents(kind);
    f->SetMinimumComponentVolume(5000.0);
    f->AddSeedPosition(place[0], place[1], place[2]);
  };
  of.IsChosenInPieces = true;
  return of;
}

const std::vector<Case> Cases = {
  { "AsTheyAre", [](vtkDeformableSurface*) {} },
  { "EdgeLength", [](vtkDeformableSurface* f) { f->SetEdgeLength(1.6); } },
  { "ShortEdgeLength", [](vtkDeformableSurface* f) { f->SetEdgeLength(0.9); } },
  { "FinestLevelBelowTheImage", [](vtkDeformableSurface* f) { f->SetFinestLevel(-1); } },
  { "FinestLevelAboveIt", [](vtkDeformableSurface* f) { f->SetFinestLevel(1); } },
  { "Tolerance", [](vtkDeformableSurface* f) { f->SetTolerance(0.3); }, ByteVoxels,
    "Tolerance is set" },
  { "ThinParts", [](vtkDeformableSurface* f) { f->ThinPartsOn(); }, ByteVoxels,
    "Thin Parts is on" },
  { "Snapshots", [](vtkDeformableSurface* f) { f->SetSnapshotInterval(10); }, ByteVoxels,
    "Snapshot Interval is set" },
  { "AttractingPositions", [](vtkDeformableSurface* f) { f->AddAttractingPosition(100, 70, 70); },
    ByteVoxels, "points attract" },
  { "StartAtTheFinest",
    [](vtkDeformableSurface* f)
    {
      f->SetCoarsestLevel(0);
      f->SetInitializationToIsoSurface();
    },
    ByteVoxels, "the surface starts there" },
  { "StartWhereAPlateHolds",
    [](vtkDeformableSurface* f)
    {
      f->SetRecovery(vtkDeformableSurface::NoRecovery);
      f->SetInitializationToIsoSurface();
    },
    Plate, "the surface starts there" },
  OfComponents("LargestComponent", vtkDeformableSurface::LargestComponent),
  OfComponents("LargeComponents", vtkDeformableSurface::LargeComponents),
  OfComponents("SmallComponentAtPoints", vtkDeformableSurface::ComponentsAtPoints),
  // From outside, on the last rank only.
  OfComponents(
    "ComponentTouchedByPoints", vtkDeformableSurface::ComponentsAtPoints, { 70.0, 70.0, 91.5 }),
  OfComponents("ComponentsNotAtSeeds", vtkDeformableSurface::ComponentsNotAtSeeds),
  { "ContactsOfLargeComponents", // of two that grow in one ball; that in the other one goes
    [](vtkDeformableSurface* f)
    {
      f->TopologyChangesOff();
      f->SetInitializationToSeeds();
      f->AddSeedPosition(108.0, 106.0, 104.0);
      f->AddSeedPosition(55.0, 70.0, 70.0);
      f->AddSeedPosition(85.0, 70.0, 70.0);
      f->SetRecovery(vtkDeformableSurface::NoRecovery);
      f->SetKeepComponents(vtkDeformableSurface::LargeComponents);
      f->SetMinimumComponentVolume(5000.0);
    },
    ByteVoxels, "", false, true },
  { "Checkpoints", [](vtkDeformableSurface*) {}, ByteVoxels, "", true },
  { "MemoryLimit", [](vtkDeformableSurface* f) { f->SetMemoryLimit(4000); }, ByteVoxels, "", true },
  { "NaNs", [](vtkDeformableSurface*) {}, VoxelsWithNaNs },
  { "NaNsOfADarkObject",
    [](vtkDeformableSurface* f)
    {
      f->ObjectIsBrightOff();
      f->SetIsoValue(70.0);
    },
    VoxelsWithNaNs },
  { "NaNsAndCheckpoints", [](vtkDeformableSurface*) {}, VoxelsWithNaNs, "", true },
  { "HiddenPoints", [](vtkDeformableSurface*) {}, HiddenPoints },
  { "HiddenCells", [](vtkDeformableSurface*) {}, HiddenCells },
};

class RankSettings : public testing::TestWithParam<Case>
{
public:
  struct Run
  {
    Ranks Filters;
    std::string Warnings; ///< of the first rank
  };

  /** Each rank has its piece of the image, which nobody else keeps. */
  Run RunOn(int count, int threads) const
  {
    const Case& is = GetParam();
    Run run;
    run.Filters.resize(static_cast<std::size_t>(count));
    ThreadControllers::Run(count,
      [&](vtkMultiProcessController* controller)
      {
        vtkNew<PieceSource> source;
        source->Whole = is.Make();
        source->ReleaseDataFlagOn();
        vtkNew<vtkImagePyramid> pyramid;
        pyramid->SetController(controller);
        pyramid->SetInputConnection(source->GetOutputPort());
        pyramid->ReleaseDataFlagOn();
        auto filter = Filter::New();
        filter->SetController(controller);
        filter->SetInputConnection(pyramid->GetOutputPort());
        filter->SetIsoValue(50.0);
        filter->SetRecovery(vtkDeformableSurface::RecoverObjectsAndCavities);
        filter->SetNumberOfThreads(threads);
        is.Set(filter);
        if (is.HasCheckpoints)
        {
          filter->SetScratchDirectory(this->Folder.Path().c_str());
        }
        const MessagesOf warnings(filter, vtkCommand::WarningEvent);
        ThreadControllers::Update(filter, controller);
        EXPECT_EQ(filter->GetErrorCode(), vtkErrorCode::NoError);
        filter->SetController(nullptr);
        pyramid->SetController(nullptr);
        if (controller->GetLocalProcessId() == 0)
        {
          run.Warnings = warnings.Get();
        }
        else
        {
          EXPECT_EQ(warnings.Get(), "");
        }
        run.Filters[static_cast<std::size_t>(controller->GetLocalProcessId())] = filter;
      });
    return run;
  }

private:
  const TemporaryFolder Folder; ///< As long as limits of memory refer to it.
};
}

TEST_P(RankSettings, AreTheSameOnAllRanks)
{
  const Run one = this->RunOn(1, 1);
  EXPECT_EQ(one.Warnings, "");
  EXPECT_GT(one.Filters.front()->GetOutput()->GetNumberOfCells(), 1000);
  for (const auto& [count, threads] : { std::pair(2, 1), std::pair(3, 2) })
  {
    SCOPED_TRACE(count);
    const Run many = this->RunOn(count, threads);
    std::vector<vtkMultiBlockDataSet*> levels;
    for (const Filter& filter : many.Filters)
    {
      levels.push_back(filter->GetLevels());
    }
    ExpectPiecesOf(one.Filters.front()->GetOutput(), SurfacesOf(many.Filters));
    ExpectBlocksOf(one.Filters.front()->GetLevels(), levels);
    // A whole would be cut evenly; each rank has what is chosen of its piece.
    const vtkIdType share = one.Filters.front()->GetOutput()->GetNumberOfCells() / count;
    const vtkIdType ofFirst = many.Filters.front()->GetOutput()->GetNumberOfCells();
    EXPECT_EQ(std::abs(ofFirst - share) > 1, GetParam().IsChosenInPieces) << ofFirst;
    const std::string told = GetParam().Told;
    EXPECT_EQ(many.Warnings.empty(), told.empty()) << many.Warnings;
    EXPECT_NE(many.Warnings.find(told), std::string::npos) << many.Warnings;
    const std::string alone = "finds the surface alone";
    const std::size_t first = many.Warnings.find(alone);
    EXPECT_EQ(first == std::string::npos, told.empty());
    EXPECT_TRUE(
      told.empty() || many.Warnings.find(alone, first + 1) == std::string::npos); // Once.
  }
}

INSTANTIATE_TEST_SUITE_P(All, RankSettings, testing::ValuesIn(Cases),
  [](const testing::TestParamInfo<Case>& info) { return std::string(info.param.Name); });
