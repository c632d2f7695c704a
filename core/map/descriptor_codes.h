// Product quantisation of what is left of a descriptor when its cell's centre is taken away, and
// the estimate of distances from it.
//
// With x = c + r + e, centre, coded rest and error, |q - c - r|^2 is |q - c|^2, plus a term of the
// descriptor alone, |r|^2 + 2 c.r, less 2 q.r, which is a sum over the parts that needs one table
// for each query, whatever the list (Babenko and Lempitsky 2014, "The inverted multi-index",
// section 3.2, split the distance like this).
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/base/random.h"
#include "core/map/descriptor_tables.h"

namespace lodemark {

// Of a sample of descriptors and the centres of their cells.
DescriptorCodebook FindCodebook(std::span<const std::uint8_t> descriptors,
                                std::span<const std::uint8_t> centres,
                                std::span<const std::uint32_t> cells, Random& random);

// Blocks of codes as DescriptorKernels::near_codes reads them.
std::vector<std::uint8_t> CodesOf(const DescriptorCodebook& codebook, const std::uint8_t* centre,
                                  std::span<const std::uint8_t> descriptors);

// Fills the query's table of kCodeTableBytes; returns what to add to an estimate, in
// kEstimateUnit.
std::int32_t FillCodeTable(const DescriptorCodebook& codebook, const std::uint8_t* query,
                           std::uint8_t* table);

}  // namespace lodemark
