// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause

/** How time and memory grow with the volume. */

#ifndef volumicSurfaceGrowth_h
#define volumicSurfaceGrowth_h

#include "SurfaceBenchmarkOptions.h"

#include <vector>

namespace volumic
{
namespace bench
{

/** y = c x^Exponent, by least squares of the logarithms. */
struct PowerLaw
{
  double Exponent = 0.0;
  double Determination = 0.0; ///< R^2 of the logarithms
  int Samples = 0;
};

/** Pairs with a value that is not positive and finite are left out. NaN with less than two places.
 */
PowerLaw FitPowerLaw(const std::vector<double>& x, const std::vector<double>& y);

/** us-1, profiled and not judged, on the volume resampled to options.Sizes, each in a process of
    its own; prints the tables and writes the CSV files. Returns whether all went well. */
bool MeasureGrowth(const SurfaceBenchmarkOptions& options);

} // namespace bench
} // namespace volumic

#endif
