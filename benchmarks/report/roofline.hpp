// SPDX-License-Identifier: MIT
/// @file
/// Kernels on one thread by operations per byte and operations per second, below what the machine can do.
#pragma once

#include "report.hpp"

#include <examples/support/line_chart.hpp>

namespace benchmarks {

/// Of measurements that count operations and bytes, and the ceilings beside them.
examples::LineChart roofline(const std::vector<Measurement>& measurements);

}  // namespace benchmarks
