// SPDX-License-Identifier: MIT
/// @file
/// What layered_body found, as figures, plots and a table of its page.
#pragma once

#include "../support/html_report.hpp"
#include "figures.hpp"

namespace examples {

void add_figures(HtmlReport& page, const Figures& figures, const Scene& scene);

}  // namespace examples
