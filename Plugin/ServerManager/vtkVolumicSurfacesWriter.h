// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   vtkVolumicSurfacesWriter
 * @brief   writes a file for each label, level or component
 *
 * The writers of the program `volumic`, for ParaView: of `organs.stl` and blocks named liver and
 * spleen `organs-liver.stl` and `organs-spleen.stl`, of one surface with several components
 * `organs-component-0.stl` and so on, each with its cavities. Of other cells, as Clip and Threshold
 * give, the outer surface is written, as triangles; it is an error if there are none. A scene, .glb or .3mf,
 * holds all in one file. Surfaces that are empty
 * are left out.
 */
#ifndef vtkVolumicSurfacesWriter_h
#define vtkVolumicSurfacesWriter_h

#include "vtkServerManagerVolumicModule.h" // For export macro
#include "vtkWriter.h"

#include <string> // For the name of the file

class VTKSERVERMANAGERVOLUMIC_EXPORT vtkVolumicSurfacesWriter : public vtkWriter
{
public:
  static vtkVolumicSurfacesWriter* New();
  vtkTypeMacro(vtkVolumicSurfacesWriter, vtkWriter);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  void SetFileName(const char* name);

protected:
  vtkVolumicSurfacesWriter();
  ~vtkVolumicSurfacesWriter() override;

  int FillInputPortInformation(int port, vtkInformation* info) override;
  void WriteData() override;

private:
  vtkVolumicSurfacesWriter(const vtkVolumicSurfacesWriter&) = delete;
  void operator=(const vtkVolumicSurfacesWriter&) = delete;

  std::string FileName;
};

#endif
