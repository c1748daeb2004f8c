// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   vtkVolumicVolumeReader
 * @brief   reads volumes as the command does
 *
 * The readers of the program `volumic`, for ParaView: NIfTI, NRRD, MetaImage, DICOM and so on in the
 * world coordinates of the file, with its directions as the direction matrix, and with the names of
 * labels where the file has them or a list lies beside it. Formats that are not packed are read in
 * the parts that are asked for.
 */
#ifndef vtkVolumicVolumeReader_h
#define vtkVolumicVolumeReader_h

#include "vtkImageAlgorithm.h"
#include "vtkServerManagerVolumicModule.h" // For export macro

#include <vtkSmartPointer.h> // For the source

#include <string> // For the name of the file

class VTKSERVERMANAGERVOLUMIC_EXPORT vtkVolumicVolumeReader : public vtkImageAlgorithm
{
public:
  static vtkVolumicVolumeReader* New();
  vtkTypeMacro(vtkVolumicVolumeReader, vtkImageAlgorithm);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  /** Of DICOM: one of the slices of the series, or its folder. */
  void SetFileName(const char* name);

  /** Of DICOM: a number from 1, or an identifier; empty: there is one series only. */
  void SetSeries(const char* series);

  /** Of several volumes in one (times, phases, masks) the one to read, counted from 0. */
  void SetTime(int time);

  /** Whether slices that are no regular grid are resampled; else they are refused. */
  void SetResampling(bool on);

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

  /** Unless that has been done. @return whether there is one. */
  bool Open();

  std::string FileName;
  std::string Series;
  int Time = 0;
  bool Resampling = true;
  vtkSmartPointer<vtkAlgorithm> Source; ///< of what it is opened; null: it is not
  vtkMTimeType OpenedTime = 0;
};

#endif
