// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicByteBudget_h
#define volumicByteBudget_h

#include <array>
#include <cstdint>

namespace tool
{
// How many bytes a file may ask for. Whoever made it may have meant harm, so no reader multiplies
// sizes, takes memory or unpacks by what a header says without asking here.

/** The most bytes of a header that is text; of lists of names; of what comes before packed voxels. */
constexpr std::uint64_t LargestText = 1 << 20;
constexpr std::uint64_t LargestNames = 16 << 20;
constexpr std::uint64_t LargestHeader = 64 << 20;

/** The product, or the largest number where that would be more: sizes of damaged headers. */
std::uint64_t Times(std::uint64_t a, std::uint64_t b);

/** Bytes of all voxels, of values whose type is as VTK numbers types; saturated as Times. */
std::uint64_t BytesOfVoxels(int type, int components, const std::array<int, 3>& size);

/**
 * How many bytes packed data may give: so many voxels, behind so many bytes of a header and what
 * comes with it. @throws Failure if these are more than any header has.
 */
std::uint64_t MostUnpacked(std::uint64_t voxels, std::uint64_t before);

/** How many bytes one packed byte gives at most. */
constexpr std::uint64_t MostOfZlib = 1100;
constexpr std::uint64_t MostOfBzip2 = 2000000;

/** @throws Failure if packed bytes, each of which gives so many at most, are fewer than needed. */
void NeedPackedBytes(std::uint64_t there, std::uint64_t most, std::uint64_t needed);

/** @throws Failure if there are fewer bytes than needed. */
void NeedBytes(std::uint64_t there, std::uint64_t needed);

/**
 * The same, and if there are more: bytes that are one too many among or before the voxels move all
 * that follow.
 */
void NeedJustBytes(std::uint64_t there, std::uint64_t needed);
}

#endif
