// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   vtkVolumicVolumeReader
 * @brief   reads volumes as the command does
 *
 * The readers of the program `volumic`, for ParaView: NIfTI, NRRD, MetaImage, DICOM and so on in the
 * world coordinates of the file, with its directions as the direction matrix, and with the names of
 * labels where the file has them or a list lies beside it. Formats that are not packed are read in
 * the parts that are asked for. Several volumes in one file are time steps.
 */
#ifndef vtkVolumicVolumeReader_h
#define vtkVolumicVolumeReader_h

#include "vtkImageAlgorithm.h"
#include "vtkServerManagerVolumicModule.h" // For export macro

#include <vtkNew.h>          // For the list of series
#include <vtkSmartPointer.h> // For the source
#include <vtkStringArray.h>  // For the list of series

#include <string> // For the name of the file

class VTKSERVERMANAGERVOLUMIC_EXPORT vtkVolumicVolumeReader : public vtkImageAlgorithm
{
public:
  static vtkVolumicVolumeReader* New();
  vtkTypeMacro(vtkVolumicVolumeReader, vtkImageAlgorithm);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  /** Of DICOM: one of the slices of the series, or its folder. */
  void SetFileName(const char* name);

  /**
   * Of DICOM: the series to read where a folder has several: its number, from 1, its line of
   * GetSeriesList(), or its identifier; empty, the default: the only one, or that of the slice.
   */
  void SetSeries(const char* series);
  vtkStringArray* GetSeriesList();

  /** Whether slices that are no regular grid are interpolated linearly, or refused. Default: on. */
  void SetResampling(bool isOn);

protected:
  vtkVolumicVolumeReader();
  ~vtkVolumicVolumeReader() override;

  int RequestInformation(
    vtkInformation* request, vtkInformationVector** input, vtkInformationVector* output) override;
  int RequestData(
    vtkInformation* request, vtkInformationVector** input, vtkInformationVector* output) override;

private:
  vtkVolumicVolumeReader(const vtkVolumicVolumeReader&) = delete;
  void operator=(const vtkVolumicVolumeReader&) = delete;

  /** Unless that has been done; of several volumes in one file that one. @return whether there is one. */
  bool Open(int time);

  std::string FileName;
  std::string Series;
  bool Resampling = true;
  vtkNew<vtkStringArray> SeriesList;
  std::string ListedName; ///< whose series they are
  int Times = 1;      ///< how many volumes the file has, which are time steps
  int OpenedStep = 0; ///< that Source is of
  vtkSmartPointer<vtkAlgorithm> Source; ///< of what it is opened; null: it is not
  vtkMTimeType OpenedTime = 0;
};

#endif
