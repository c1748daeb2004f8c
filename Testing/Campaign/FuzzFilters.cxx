// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause

/**
 * Run the filters on inputs and properties from libFuzzer. VOLUMIC_FUZZ=points varies the data at
 * ports 1 and 2 of vtkDeformableSurface, otherwise the image varies. A run reports an error and
 * leaves empty outputs, or it makes closed, manifold, oriented surfaces. Then the same filter must
 * make the same surfaces of a valid image as a new filter.
 */

#include "Settings/PropertyTable.h"
#include "SupportVtkConversions.h"
#include "vtkImagePyramid.h"
#include "vtkLabelsToSurfaces.h"
#include "vtkVolumeToSurface.h"

#include <fuzzer/FuzzedDataProvider.h>
#include <vtkCallbackCommand.h>
#include <vtkCellData.h>
#include <vtkExecutive.h>
#include <vtkIdTypeArray.h>
#include <vtkLogger.h>
#include <vtkMultiBlockDataSet.h>
#include <vtkSphereSource.h>

#include <functional>

namespace
{
struct Fuzzer : FuzzedDataProvider
{
  using FuzzedDataProvider::FuzzedDataProvider;
  int Size = 1; ///< of the last image along x and y

  int In(int low, int high) { return this->ConsumeIntegralInRange(low, high); }
  bool OneIn(int n) { return this->In(1, n) == n; }
  int Integer(int low, int high) { return OneIn(8) ? ConsumeIntegral<int>() : In(low, high); }
  double Real(double low, double high)
  {
    constexpr double infinity = std::numeric_limits<double>::infinity();
    return !OneIn(8) ? ConsumeFloatingPointInRange(low, high)
      : OneIn(2)     ? std::ldexp(ConsumeFloatingPointInRange(-1., 1.), In(-1100, 1100))
                     : PickValueInArray({ 0., std::nan(""), infinity, -infinity, -1., 3e38 });
  }
  bool Take(bool) { return this->OneIn(2); }
  int Take(int) { return this->Integer(-1, 4); }
  double Take(double) { return this->Real(0., PickValueInArray({ .3, 1., 3., 100. })); }
  const char* Take(const char*) { return this->OneIn(2) ? "/tmp" : "/nowhere"; }

  /** Return an array, usually of the type and size, with a ball (0), labels (1) or noise (2). */
  vtkSmartPointer<vtkAbstractArray> Array(const char* name, int n, int type, int pattern)
  {
    auto array = vtk::TakeSmartPointer(vtkAbstractArray::CreateArray(OneIn(4) ? In(1, 25) : type));
    array->SetName(name);
    array->SetNumberOfComponents(OneIn(8) ? In(1, 4) : 1);
    array->SetNumberOfTuples(std::clamp(OneIn(16) ? n / 2 + In(0, 40) : n, 0, 5000));
    auto* numbers = vtkDataArray::SafeDownCast(array);
    n = numbers ? static_cast<int>(numbers->GetNumberOfTuples()) : 0;
    for (int i = 0; i < n; ++i)
    {
      const int at[] = { i % Size - Size / 2, i / Size % Size - Size / 2, i / Size / Size - 4 };
      const double ball = 130. - 25. * std::hypot(at[0], at[1], at[2]);
      const double values[] = { std::clamp(ball, 0., 100.), ball > 50. ? at[0] < 1 ? 1. : 2. : 0.,
        static_cast<double>((i * 7919 + 13) % 101), 1., 3., 5. };
      numbers->SetTuple(i, values + pattern);
    }
    for (int left = n > 0 ? In(0, 6) : 0; left > 0; --left)
    {
      numbers->SetComponent(In(0, n - 1), 0, this->Real(0., 100.));
    }
    return array;
  }

  vtkSmartPointer<vtkImageData> Image(int pattern)
  {
    auto image = vtkSmartPointer<vtkImageData>::New();
    const bool isAbsurd = OneIn(2);
    this->Size = In(8, 11);
    int extent[6];
    double geometry[15]; // spacing, origin, direction
    for (int axis = 0; axis < 3; ++axis)
    {
      const int n = OneIn(16) ? Integer(-2, 7) : this->Size;
      extent[2 * axis] = isAbsurd ? Integer(-5, 5) : 0;
      extent[2 * axis + 1] = static_cast<int>(std::int64_t(extent[2 * axis]) + n - 1);
    }
    image->SetExtent(extent);
    if (isAbsurd)
    {
      std::generate_n(geometry, 15, [&] { return this->Real(.5, 2.); });
      image->SetSpacing(geometry);
      image->SetOrigin(geometry + 3);
      OneIn(4) ? image->SetDirectionMatrix(geometry + 6) : void();
    }
    const int owner = OneIn(16) ? vtkDataObject::CELL : vtkDataObject::POINT;
    for (const int type : { vtkDataObject::POINT, vtkDataObject::CELL })
    {
      const auto n = static_cast<int>(std::min<vtkIdType>(image->GetNumberOfElements(type), 5000));
      vtkDataSetAttributes* data = image->GetAttributes(type);
      data->AddArray(OneIn(8) ? Array("vtkGhostType", n, VTK_UNSIGNED_CHAR, 2) : nullptr);
      data->AddArray(type == owner ? Array("Voxels", n, VTK_FLOAT, pattern) : nullptr);
      data->SetActiveScalars("Voxels");
    }
    for (const auto& [name, type] : { std::pair("LabelValues", VTK_DOUBLE),
           { "LabelColors", VTK_DOUBLE }, { "LabelNames", VTK_STRING }, { "Unit", VTK_STRING } })
    {
      image->GetFieldData()->AddArray(OneIn(8) ? Array(name, Integer(0, 3), type, 2) : nullptr);
    }
    return image;
  }

  /** Return an image, or a pyramid with an arbitrary level. */
  vtkSmartPointer<vtkDataObject> Input(int pattern)
  {
    const vtkSmartPointer<vtkImageData> image = this->Image(pattern);
    if (!OneIn(3))
    {
      return image;
    }
    vtkNew<vtkImagePyramid> pyramid;
    pyramid->SetInputData(image);
    pyramid->SetMinimumLevelSize(4);
    pyramid->Update();
    auto blocks = vtkSmartPointer<vtkMultiBlockDataSet>::New();
    blocks->DeepCopy(pyramid->GetOutput());
    OneIn(2) ? blocks->SetBlock(static_cast<unsigned>(In(0, 2)), this->Image(pattern)) : void();
    return blocks;
  }

  /** Return spheres with arbitrary changes of points and cells. */
  vtkSmartPointer<vtkPolyData> Points()
  {
    auto data = vtkSmartPointer<vtkPolyData>::New();
    vtkNew<vtkPoints> points;
    points->SetDataType(OneIn(4) ? In(VTK_CHAR, VTK_DOUBLE) : VTK_DOUBLE);
    vtkNew<vtkCellArray> cells[4]; // vertices, lines, polygons, strips
    const auto count = [&] { return static_cast<int>(points->GetNumberOfPoints()); };
    const auto id = [&] { return this->Integer(0, count()); };
    const auto addSphere = [&](const double* center, double radius)
    {
      vtkNew<vtkSphereSource> sphere;
      sphere->SetCenter(center[0], center[1], center[2]);
      sphere->SetRadius(radius);
      sphere->Update();
      vtkPolyData* made = sphere->GetOutput();
      cells[2]->Append(made->GetPolys(), count());
      points->InsertPoints(count(), made->GetNumberOfPoints(), 0, made->GetPoints());
    };
    const double middle[] = { 4., 4., 4. };
    OneIn(4) ? void() : addSphere(middle, 4.);
    for (int left = In(0, 6); left > 0; --left)
    {
      vtkCellArray* chosen = cells[OneIn(2) ? In(0, 3) : 2];
      const vtkIdType cell = In(0, static_cast<int>(chosen->GetNumberOfCells()));
      const bool isTriangle = cell < chosen->GetNumberOfCells() && chosen->GetCellSize(cell) == 3;
      const double at[] = { Real(0., 9.), Real(0., 9.), Real(0., 9.) };
      const std::function<void()> edits[] = { [&]
        { isTriangle ? chosen->ReverseCellAtId(cell) : void(); },
        [&] {
          isTriangle ? chosen->ReplaceCellAtId(cell, { id(), id(), id() }) : void();
        },
        [&] {
          chosen->InsertNextCell({ id(), id(), id(), id(), id() });
        },
        [&] { chosen->InsertNextCell({ id() }); }, [&] { chosen->InsertNextCell(0); },
        [&] { addSphere(at, this->Real(.2, 9.)); },
        [&] { points->InsertPoint(In(0, count()), at); } };
      edits[In(0, 6)]();
    }
    if (OneIn(16)) // offsets that do not match the corners
    {
      vtkNew<vtkIdTypeArray> offsets;
      offsets->DeepCopy(this->Array("", In(0, 9), VTK_ID_TYPE, 1));
      cells[In(0, 3)]->SetData(offsets, vtkNew<vtkIdTypeArray>());
    }
    data->SetPoints(OneIn(16) ? nullptr : points.Get());
    data->SetVerts(cells[0]);
    data->SetLines(cells[1]);
    data->SetPolys(cells[2]);
    data->SetStrips(cells[3]);
    data->GetPointData()->AddArray(OneIn(2) ? Array("Weight", count(), VTK_INT, 1) : nullptr);
    data->GetPointData()->AddArray(OneIn(2) ? Array("Radius", count(), VTK_INT, 1) : nullptr);
    return data;
  }
};

// Set each property to that of `valid`, or with a fuzzer only the one whose turn it is.
#define FUZZ(name, type, ...)                                  \
  if (type value = valid->Get##name(); !fuzzer || turn-- == 0) \
  {                                                            \
    filter->Set##name(fuzzer ? fuzzer->Take(value) : value);   \
  }
#define SKIP(...)

template <typename Filter>
void SetProperties(Filter* filter, Filter* valid, Fuzzer* fuzzer, int turn)
{
  FUZZ(NumberOfThreads, int) FUZZ(ScratchDirectory, const char*);
  if constexpr (std::is_same_v<Filter, vtkLabelsToSurfaces>)
  {
    FUZZ(BackgroundLabel, int) FUZZ(Merge, bool) FUZZ(Smoothing, double) FUZZ(Metric, int);
    FUZZ(VoxelTolerance, double) FUZZ(BoxFaces, int) FUZZ(EdgeLength, double);
    FUZZ(Tolerance, double) FUZZ(Gradation, double) FUZZ(MaximumEdgeLength, double);
    FUZZ(FinestLevel, int) FUZZ(KeepComponents, int) FUZZ(MinimumComponentVolume, double);
    FUZZ(TimeLimit, double);
    fuzzer ? filter->AddLabel(fuzzer->Integer(0, 3)) : filter->ClearLabels();
  }
  else if constexpr (!std::is_same_v<Filter, vtkDeformableSurface>)
  {
    FUZZ(NumberOfLevels, int) FUZZ(MinimumLevelSize, int) FUZZ(ReductionFactor, double);
    FUZZ(SelectedComponent, int) FUZZ(NaNIsBackground, bool);
  }
  if constexpr (std::is_base_of_v<vtkDeformableSurface, Filter>)
  {
    VOLUMIC_SURFACE_PROPERTIES(FUZZ, SKIP);
    fuzzer ? void() : filter->ClearSeedPositions();
    fuzzer&& turn-- == 0 ? filter->AddSeedPosition(4., 5., fuzzer->Real(-1., 11.)) : void();
    // An execution shall take milliseconds.
    filter->SetMaximumNumberOfIterations(std::min(filter->GetMaximumNumberOfIterations(), 30));
  }
}

int Errors = 0; ///< of the last update

void Expect(bool isTrue, const char* what)
{
  isTrue ? void() : (std::fprintf(stderr, "FuzzFilters: expected %s\n", what), std::abort());
}

/** Update a filter and check its outputs. Return the sum of all coordinates. */
double Update(vtkAlgorithm* filter, bool isMoved)
{
  using namespace volumic::support;
  Errors = 0;
  filter->Update();
  Expect(Errors > 0 || filter->GetErrorCode() == 0, "a message after an error");
  double sum = 0.;
  for (int port = 0; port < filter->GetNumberOfOutputPorts(); ++port)
  {
    vtkDataObject* output = filter->GetOutputDataObject(port);
    auto* blocks = vtkMultiBlockDataSet::SafeDownCast(output);
    std::vector<vtkPolyData*> surfaces = { vtkPolyData::SafeDownCast(output) };
    surfaces = blocks ? vtkCompositeDataSet::GetDataSets<vtkPolyData>(blocks) : surfaces;
    Expect(Errors == 0 || !blocks || blocks->GetNumberOfBlocks() == 0, "no blocks after an error");
    for (int type = 0; type < vtkDataObject::NUMBER_OF_ATTRIBUTE_TYPES; ++type)
    {
      Expect(Errors == 0 || output->GetNumberOfElements(type) == 0, "empty outputs after an error");
    }
    for (vtkPolyData* surface : surfaces)
    {
      if (surface && surface->GetNumberOfLines() == 0 && surface->GetNumberOfPolys() > 0 &&
        !surface->GetCellData()->HasArray("BoundaryLabels"))
      {
        const TriangleSurface triangles = ToTriangleSurface(surface);
        const TopologyVerdict verdict = JudgeTopology(triangles);
        Expect(verdict.Closed && verdict.Manifold && verdict.Oriented, "a valid surface");
        Expect(isMoved || JudgeIntersections(triangles).Pairs == 0, "no intersection");
        sum += verdict.Area + verdict.Volume;
      }
    }
  }
  return sum;
}

template <typename Filter>
void Run(Fuzzer& fuzzer)
{
  constexpr bool isSurface = std::is_base_of_v<vtkDeformableSurface, Filter>;
  constexpr int pattern = std::is_same_v<Filter, vtkLabelsToSurfaces> ? 1 : 0;
  static const auto image = Fuzzer(nullptr, 0).Image(pattern);
  const bool hasPoints = std::getenv("VOLUMIC_FUZZ") != nullptr;
  vtkNew<Filter> valid;
  vtkNew<Filter> filter;
  vtkNew<vtkCallbackCommand> listener;
  listener->SetCallback([](vtkObject*, unsigned long, void*, void*) { ++Errors; });
  filter->AddObserver(vtkCommand::ErrorEvent, listener);
  filter->GetExecutive()->AddObserver(vtkCommand::ErrorEvent, listener);
  valid->SetNumberOfThreads(1);
  if constexpr (isSurface)
  {
    valid->SetIsoValue(50.);
  }
  const auto updateValid = [&](Filter* with)
  {
    SetProperties<Filter>(with, valid, nullptr, 0);
    with->SetInputArrayToProcess(0, 0, 0, 0, vtkDataSetAttributes::SCALARS);
    for (int port = 0; port < with->GetNumberOfInputPorts(); ++port)
    {
      with->SetInputDataObject(port, port == 0 ? image.Get() : nullptr);
    }
    return Update(with, false);
  };
  static const double sum = updateValid(vtkNew<Filter>());
  SetProperties<Filter>(filter, valid, nullptr, 0);
  filter->SetInputDataObject(image);
  if (!hasPoints)
  {
    filter->SetInputDataObject(fuzzer.Input(isSurface ? fuzzer.In(0, 2) : pattern));
    fuzzer.OneIn(9) ? filter->SetInputArrayToProcess(0, 0, 0, fuzzer.In(0, 3), "Voxels") : void();
    fuzzer.OneIn(4) ? filter->SetInputArrayToProcess(1, 0, 0, 0, "Voxels") : void();
  }
  if constexpr (isSurface)
  {
    filter->SetInitialization(hasPoints ? fuzzer.In(1, 3) : 0);
    filter->SetInitialSurfaceData(fuzzer.OneIn(2) ? fuzzer.Points().Get() : nullptr);
    filter->SetAttractingPointsData(fuzzer.OneIn(3) ? fuzzer.Points().Get() : nullptr);
  }
  for (int left = fuzzer.In(0, 3); left > 0; --left)
  {
    SetProperties<Filter>(filter, valid, &fuzzer, fuzzer.In(0, 55));
  }
  Update(filter, !hasPoints);
  if (fuzzer.OneIn(4))
  {
    Expect(updateValid(filter) == sum && Errors == 0, "the result of a new filter");
  }
}
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size)
{
  vtkLogger::SetStderrVerbosity(vtkLogger::VERBOSITY_OFF);
  constexpr void (*runs[])(Fuzzer&) = { Run<vtkDeformableSurface>, Run<vtkVolumeToSurface>,
    Run<vtkImagePyramid>, Run<vtkLabelsToSurfaces> };
  Fuzzer fuzzer(data, size);
  runs[fuzzer.In(0, std::getenv("VOLUMIC_FUZZ") ? 1 : 3)](fuzzer);
  return 0;
}
