// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef AlgorithmErrors_h
#define AlgorithmErrors_h

#include <string>

class vtkAlgorithm;

namespace volumic
{
/// Updates an algorithm that works within another one; what it reports as an error is not printed
/// but returned, without the place in the source. Empty if all went well.
std::string UpdateAndCollectErrors(vtkAlgorithm* algorithm);
}

#endif
