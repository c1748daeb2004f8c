// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause

// Checkpoints that are not believed, and those that could not be left.
#include "CheckpointTestTools.h"

#include "Core/Common/CheckedFile.h"

#include <cstdint>
#include <fstream>

using namespace volumic;

TEST_F(Checkpoints, OfOtherSettingsAreRefusedByName)
{
  this->StopARun();
  const auto sphere = SphereAt({ 22, 22, 22 }, 17, 24);
  const std::vector<std::pair<std::string, Choice>> changes = {
    { "Iso Value was 50 and is 50.1", [](vtkDeformableSurface* f) { f->SetIsoValue(50.1); } },
    { "Friction was 3 and is 2.5", [](vtkDeformableSurface* f) { f->SetFriction(2.5); } },
    { "not the same Recovery",
      [](vtkDeformableSurface* f) { f->SetRecovery(vtkDeformableSurface::NoRecovery); } },
    { "not the same Seed Positions", [](vtkDeformableSurface* f) { f->AddSeedPosition(9, 9, 9); } },
    { "not the same Initial Surface (input port 1)",
      [&](vtkDeformableSurface* f) { f->SetInitialSurfaceData(sphere); } },
    { "not the same Attracting Points (input port 2)",
      [&](vtkDeformableSurface* f)
      {
        vtkNew<vtkPolyData> points;
        points->SetPoints(sphere->GetPoints());
        f->SetAttractingPointsData(points);
        f->SetPointAttractionWeight(0.0);
      } },
    { "other settings: Tolerance was 0 and is 0.4. Set",
      [](vtkDeformableSurface* f) { f->SetTolerance(0.4); } },
    { "Snapshot Interval was 0 and is 9",
      [](vtkDeformableSurface* f) { f->SetSnapshotInterval(9); } },
    { "Coarsest Level was 2 and is 1", [](vtkDeformableSurface* f) { f->SetCoarsestLevel(1); } },
    { "not the same levels of the pyramid",
      [](vtkDeformableSurface* f)
      { vtkVolumeToSurface::SafeDownCast(f)->SetReductionFactor(1.6); } }
  };
  for (const auto& [what, choose] : changes)
  {
    const std::string error = this->ErrorOfResuming(choose);
    EXPECT_TRUE(
      Has(error, "Resume: the checkpoint " + this->CheckpointFolder() + " is of other settings: "));
    EXPECT_TRUE(Has(error, what)) << what << ": " << error;
    EXPECT_TRUE(Has(error, "switch Resume off"));
  }
  EXPECT_EQ(this->Resume()->GetResumedLevel(), 1) << "it is still there";
}

TEST_F(Checkpoints, TellOfTheNearestOne)
{
  this->StopARun([](vtkDeformableSurface* f)
    {
      f->SetIsoValue(40.0);
      f->SetFriction(4.0);
    });
  this->StopARun([](vtkDeformableSurface* f) { f->SetIsoValue(45.0); });
  EXPECT_EQ(this->Folder.Names().size(), 2u) << "each has a folder of its own";
  const std::string error = this->ErrorOfResuming();
  EXPECT_TRUE(Has(error, "is of other settings: Iso Value was 45 and is 50."));
  EXPECT_EQ(this->Resume([](vtkDeformableSurface* f) { f->SetIsoValue(45.0); })->GetResumedLevel(),
    1);
}

TEST_F(Checkpoints, OfAnotherVolumeAreRefused)
{
  this->StopARun();
  Voxels(this->Image)->SetComponent(4711, 0, 1.5);
  this->Image->Modified();
  EXPECT_TRUE(Has(this->ErrorOfResuming(), "is of another volume: not the same voxels"));
  this->Image = CheckpointScene();
  this->Image->SetSpacing(1, 1, 2);
  EXPECT_TRUE(Has(this->ErrorOfResuming(), "not the same place of the volume"));
  this->Image = CheckpointScene(45);
  EXPECT_TRUE(Has(this->ErrorOfResuming(), "not the same size of the volume"));
  this->Image = CheckpointScene();
  EXPECT_EQ(this->Resume()->GetResumedLevel(), 1);
}

TEST_F(Checkpoints, AreRefusedWhereTheyAreDamaged)
{
  this->StopARun();
  const std::string file = this->CheckpointFolder() + "/level-1";
  std::filesystem::resize_file(file, std::filesystem::file_size(file) / 2);
  EXPECT_TRUE(Has(this->ErrorOfResuming(), file + " is damaged"));
  const auto anew = this->NewFilter();
  anew->Update(); // Replaces it.
  ExpectSameOutputs(anew, this->Uninterrupted());
  EXPECT_EQ(this->Folder.Names(), std::set<std::string>());
}

/** Changes a byte, and signs the file anew, as only who means harm does. */
static void ChangeSigned(const std::string& name, std::size_t seed)
{
  struct
  {
    std::uint64_t Count;
    std::uint64_t Hash;
  } head{};
  std::string content;
  {
    std::ifstream file(name, std::ios::binary);
    while (file.read(reinterpret_cast<char*>(&head), sizeof(head)) && head.Count > 0)
    {
      const std::size_t before = content.size();
      content.resize(before + head.Count);
      file.read(&content[before], static_cast<std::streamsize>(head.Count));
    }
  }
  // Every other one among the first numbers, which say how many others there are.
  const std::size_t span = seed % 2 == 0 ? content.size() : content.size() / 20;
  content[seed * 2654435761U % span] ^= static_cast<char>(seed % 3 == 0 ? 0x80 : 1 << seed % 7);
  CheckedWriter file(name);
  file.Write(content.data(), content.size());
  file.Commit();
}

TEST_F(Checkpoints, EndNoProgramWhereTheyAreSignedAnew)
{
  this->StopARun();
  const std::string folder = this->CheckpointFolder();
  const TemporaryFolder aside;
  std::filesystem::copy(folder, aside.File("whole"));
  for (std::size_t seed = 1; seed <= 60; ++seed)
  {
    SCOPED_TRACE(seed);
    std::filesystem::remove_all(folder);
    std::filesystem::copy(aside.File("whole"), folder);
    ChangeSigned(folder + "/level-1", seed);
    const auto filter = this->NewFilter();
    const MessagesOf errors(filter);
    filter->SetTimeLimit(0.2);
    filter->ResumeOn();
    filter->Update(); // is refused, or goes on: whoever may sign may say where a vertex is
  }
}

TEST_F(Checkpoints, AreGivenUpWhereTheDiskIsFull)
{
  for (const int bytes : { 0, 100, 20000, 60000, 120000 })
  {
    SCOPED_TRACE(bytes);
    const auto filter = this->NewFilter();
    const MessagesOf warnings(filter, vtkCommand::WarningEvent);
    const MessagesOf errors(filter);
    filter->LeaveCheckpoints();
    {
      const LimitedFileSize limit(bytes);
      filter->Update();
    }
    EXPECT_EQ(errors.Get(), "");
    EXPECT_TRUE(warnings.Has("could not be left: " + this->Folder.Path())) << warnings.Get();
    EXPECT_TRUE(warnings.Has("File too large")) << warnings.Get();
    const std::string folder = filter->GetCheckpointFolder();
    const bool canResume = warnings.Has("can be resumed from level");
    EXPECT_EQ(canResume, !folder.empty()) << warnings.Get();
    EXPECT_EQ(this->Folder.Names().size(), canResume ? 1u : 0u) << "nothing is left for nothing";
    ExpectSameOutputs(filter, this->Uninterrupted());
    if (canResume)
    {
      filter->SetScratchDirectory("");
      filter->SetInputData(CheckpointScene(20));
      filter->Update(); // Lets go of the folder.
      EXPECT_GE(this->Resume()->GetResumedLevel(), 1);
    }
  }
}

TEST_F(Checkpoints, NeedADirectoryThatIsThere)
{
  const auto filter = this->NewFilter();
  const MessagesOf errors(filter);
  filter->SetScratchDirectory(this->Folder.File("none").c_str());
  filter->Update();
  EXPECT_TRUE(errors.Has("Scratch Directory " + this->Folder.File("none") + " cannot be used"))
    << errors.Get();
  std::ofstream(this->Folder.File("file")) << "a";
  filter->SetScratchDirectory(this->Folder.File("file").c_str());
  filter->Update();
  EXPECT_TRUE(errors.Has("cannot be used: Not a directory")) << errors.Get();
  filter->SetScratchDirectory(this->Folder.Path().c_str());
  filter->Update();
  ExpectSameOutputs(filter, this->Uninterrupted());
}
