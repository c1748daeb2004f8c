#!/bin/bash
# SPDX-FileCopyrightText: Copyright (c) Volumic contributors
# SPDX-License-Identifier: BSD-3-Clause
#
# Builds the benchmarks and runs them: the pyramid on the skull CT of Debian's invesalius-examples
# and on a generated volume, then the surface beside its peers, on the skull or on other volumes. The
# machine should have nothing else to do.

set -eo pipefail
. "$(dirname "${BASH_SOURCE[0]}")/../../CMake/debian.sh"

usage()
{
  cat << 'USAGE'
Usage: bash Testing/Benchmarks/run.sh [OPTION]...
  --with-itk           install ITK (large), to be compared with too; used anyway where it is there
  --surface-only       leave the pyramid out
  --pyramid-only       leave the surface out
  --generate SIZE      voxels along the axes of the generated volume (default 512; 0: leave it out)
  --repetitions N      per program and volume (default: of the pyramid 15 on the skull, 5 on the
                       generated volume, of the surface 1)
The surface:
  --volume FILE.vti --iso VALUE   on this volume instead of the skull
  --all-scans          on the skull and on all volumes of ../shared/data, where that folder is
  --slow               also beside ITK's level set, which takes minutes
  --no-recovery        also without Recovery
  --growth             also how cost grows, on the volume resampled to 64^3 ... 512^3 voxels
  --max-size N         of these, those up to N^3
  --threads            also what a second thread gains, as it is and resampled to 512^3 voxels:
                       medians of 5 rounds, or of --repetitions
  --model              also what 2 to 64 threads would gain, by a model, on the same two
  --memory             also what memory it takes, resampled to 512^3 and 1024^3 voxels
  --limit LIST         also what limits of memory cost, such as 300M,1G: measure_limit.py
Surfaces of labels:
  --labels             also these: digitised shapes, the label maps of Debian's mricron-data, those
                       made of ../shared/data where that is, and one with the size of a body
  --labels-only        nothing else
Graded triangles:
  --graded             these, and nothing else: of the skull, and of the engine and the tooth of
                       ../shared/data where that is, beside uniform ones, decimated ones, CGAL's
                       adaptive remeshing (CGAL 6) and mmgs, where there is one; 3 repetitions
Surfaces of labels that touch:
  --interfaces         these, and nothing else: sharing their interfaces, and not, beside
                       vtkSurfaceNets3D (VTK 9.3) and vtkDiscreteFlyingEdges3D with
                       vtkWindowedSincPolyDataFilter, and whether TetGen and gmsh fill them
  --maps LIST          of polycrystal,tooth,organs,aal,JHU (default: all)
  --help               this text
Tables are printed; all figures are left in build/benchmarks: every repetition of the pyramid in
*.json, the surface in surface-NAME*.csv and surface-NAME.vtp, the others in growth-NAME*.csv,
threads-NAME*.csv, model-NAME*.csv, memory-NAME*.csv, limit-NAME.csv, labels-NAME*.csv,
graded*.csv, interfaces*.csv.
USAGE
}

generated_size=512
repetitions=
with_pyramid=yes
with_surface=yes
with_labels=
with_graded=
with_interfaces=
interface_options=()
volume=
iso=
all_scans=
growth=
limits=
scaling=()
surface_options=()
growth_options=()
packages=("${tool_packages[@]}" libbenchmark-dev libcgal-dev)
take_option()
{
  case $1 in
    --with-itk) packages+=(libinsighttoolkit5-dev) ;;
    --surface-only) with_pyramid= ;;
    --pyramid-only) with_surface= ;;
    --labels)
      with_labels=yes
      packages+=(mricron-data)
      ;;
    --labels-only)
      with_labels=yes
      with_pyramid=
      with_surface=
      packages+=(mricron-data)
      ;;
    --graded)
      with_graded=yes
      with_pyramid=
      with_surface=
      packages+=(libeigen3-dev)
      ;;
    --interfaces)
      with_interfaces=yes
      with_pyramid=
      with_surface=
      packages+=(mricron-data tetgen gmsh)
      ;;
    --maps)
      need_value "a value" "$@"
      interface_options+=("$1" "$2")
      ;;
    --slow | --no-recovery) surface_options+=("$1") ;;
    --all-scans) all_scans=yes ;;
    --growth) growth=yes ;;
    --threads | --model | --memory) scaling+=("${1#--}") ;;
    --volume)
      need_value "a value" "$@"
      volume=$2
      ;;
    --iso)
      need_value "a value" "$@"
      iso=$2
      ;;
    --limit)
      need_value "a value" "$@"
      limits=$2
      ;;
    --generate)
      need_number "$@"
      generated_size=$2
      ;;
    --repetitions)
      need_number "$@"
      repetitions=$2
      ;;
    --max-size)
      need_number "$@"
      growth_options+=("$1" "$2")
      ;;
    *) return 1 ;;
  esac
}
parse_options "$@"
[ -z "$volume" ] || [ -n "$iso" ] || fail "--volume needs --iso VALUE"
[ -z "$iso" ] || [ -n "$volume" ] || fail "--iso needs --volume FILE.vti"

folder=$root/Testing/Benchmarks
results=$build/benchmarks
mkdir -p "$results"

check_system
plan_steps $((4 + $(skull_steps)))
mapfile -t needed < <(vtk_packages; skull_packages)
install_packages "${packages[@]}" "${needed[@]}"
prepare_skull
build_vtk_flavour -DVOLUMIC_BUILD_BENCHMARKS=ON
run_step "Reading the skull CT" benchmark-skull \
  "$build/install-vtk/bin/volumic" "$(cranium)" --write-volume "$results/skull.vti"

# list_scans: name, file and iso-value of the volumes of ../shared/data, from the table there. Of
# several iso-values the first; half a step up where voxels are whole numbers, so that none equals it.
list_scans()
{
  local folder=$root/../shared/data
  [ -f "$folder/MANIFEST.md" ] || return 0
  awk -F ' *[|] *' -v folder="$folder" '$2 ~ /\.vti$/ {
    split($8, iso, " ")
    name = substr($2, 1, length($2) - 4)
    print name, folder "/" $2, ($6 ~ /float|double/ ? iso[1] : iso[1] + 0.5)
  }' "$folder/MANIFEST.md"
}

# measure_surface NAME FILE ISO. A run that fails is told in its table and doesn't stop the others.
failed=
measure_surface()
{
  local program=(python3 "$folder/benchmark_surface.py"
    --program "$build/vtk/bin/BenchmarkSurface")
  say ""
  "${program[@]}" --volume "$2" --iso "$3" --repetitions "${repetitions:-1}" --profile \
    --csv "$results/surface-$1.csv" --output "$results/surface-$1.vtp" "${surface_options[@]}" \
    || failed=yes
  if [ -n "$growth" ]; then
    say ""
    "${program[@]}" --volume "$2" --iso "$3" --growth --csv "$results/growth-$1.csv" \
      "${growth_options[@]}" || failed=yes
  fi
  local what options
  for what in "${scaling[@]}"; do
    case $what in
      threads) options=(--threads 1,2 --sizes 0,512 --repetitions "${repetitions:-5}") ;;
      model) options=(--model --sizes 0,512) ;;
      memory) options=(--memory) ;;
    esac
    say ""
    "${program[@]}" --volume "$2" --iso "$3" "${options[@]}" --csv "$results/$what-$1.csv" || failed=yes
  done
  if [ -n "$limits" ]; then
    say ""
    python3 "$folder/measure_limit.py" --program "$build/vtk/bin/volumic" \
      --memory "$limits" --csv "$results/limit-$1.csv" "$2" --iso "$3" || failed=yes
  fi
}

# measure_labels NAME OPTION...
measure_labels()
{
  local name=$1
  shift
  say ""
  python3 "$folder/benchmark_labels.py" --program "$build/vtk/bin/BenchmarkLabels" \
    --repetitions "${repetitions:-1}" "$@" \
    --csv "$results/labels-$name.csv" || failed=yes
}

measure_all_labels()
{
  local maps=/usr/share/mricron/templates scan=$root/../shared/data/brain_mr_u8.vti name
  measure_labels shapes --sizes 64,128
  measure_labels shapes-large --sizes 256 --stretches 1 --shapes Sphere,Torus,Gyroid,ThinShell
  for name in aal JHU-WhiteMatter-labels-1mm inia19-NeuroMaps; do
    measure_labels "$name" --map "$maps/$name.nii.gz"
  done
  measure_labels ch2bet --map "$maps/ch2bet.nii.gz" --mask
  # The same as a mask that somebody has looked at: without single voxels.
  measure_labels ch2bet-median --scan "$maps/ch2bet.nii.gz" --thresholds 20
  if [ -f "$scan" ]; then
    measure_labels head --scan "$scan" --thresholds 22
    measure_labels tissues --scan "$scan" --thresholds 22,60,110
  fi
  measure_labels body --body 512,512,400 --runs us --threads "$(nproc)"
}

measure_graded()
{
  local scans=(--scan skull "$results/skull.vti" 226.5) scan name file iso
  local options=() adaptive=$build/vtk/bin/AdaptiveRemesh
  for scan in "engine engine_ct_u8.vti 75" "tooth tooth_ct_u16.vti 600"; do
    read -r name file iso <<< "$scan"
    file=$root/../shared/data/$file
    if [ -f "$file" ]; then
      scans+=(--scan "$name" "$file" "$iso")
    else
      say "The $name is left out: $(basename "$file") is not beside the checkout, in ../shared/data."
    fi
  done
  [ ! -x "$adaptive" ] || options+=(--adaptive "$adaptive")
  "$(vtk_python)" "$folder/benchmark_graded.py" --program "$build/vtk/bin/volumic" \
    --judge "$build/vtk/bin/JudgeFiles" "${options[@]}" --repetitions "${repetitions:-3}" \
    --csv "$results/graded.csv" "${scans[@]}" || failed=yes
}

measure_interfaces()
{
  local package
  package=$(find "$build/install-vtk" -type d -name volumic -path '*-packages/volumic' | head -n 1)
  PYTHONPATH=$(dirname "$package")${PYTHONPATH:+:$PYTHONPATH} \
    "$(vtk_python)" "$folder/benchmark_interfaces.py" --judge "$build/vtk/bin/JudgeFiles" \
    --make-volume "$build/vtk/bin/MakeVolume" --repetitions "${repetitions:-1}" \
    --csv "$results/interfaces.csv" "${interface_options[@]}" || failed=yes
}

sed -n 's/^model name[^:]*: /Processor: /p' /proc/cpuinfo | sort -u
if [ -n "$with_pyramid" ]; then
  pyramid=(python3 "$folder/benchmark_pyramid.py"
    --program "$build/vtk/bin/BenchmarkImagePyramid")
  "${pyramid[@]}" --volume "$results/skull.vti" --repetitions "${repetitions:-15}" \
    --json "$results/pyramid-skull.json"
  if [ "$generated_size" -gt 0 ]; then
    "${pyramid[@]}" --generate "$generated_size" --repetitions "${repetitions:-5}" \
      --json "$results/pyramid-generated.json"
  fi
fi
if [ -n "$with_surface" ]; then
  if [ -n "$volume" ]; then
    measure_surface "$(basename "$volume" .vti)" "$volume" "$iso"
  else
    measure_surface skull "$results/skull.vti" 226.5
  fi
  if [ -n "$all_scans" ]; then
    list_scans > "$results/scans"
    [ -s "$results/scans" ] || say "No volumes beside the checkout, in ../shared/data."
    while read -r name file iso; do
      measure_surface "$name" "$file" "$iso"
    done < "$results/scans"
  fi
fi
[ -z "$with_labels" ] || measure_all_labels
[ -z "$with_graded" ] || measure_graded
[ -z "$with_interfaces" ] || measure_interfaces
[ -z "$failed" ] || fail "Some runs failed; see above."
