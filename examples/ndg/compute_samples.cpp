// SPDX-License-Identifier: MIT
#include "compute_samples.hpp"

#include "../support/direct_cholesky.hpp"

namespace examples {

using namespace softtissue;

GenerationProgress compute_samples(const DatasetFolder& folder, const BodyFunction& maker,
                                   const GenerationOptions& options,
                                   const std::function<bool(const GenerationProgress&)>& observer) {
    return generate_dataset<DirectCholesky>(folder, maker, options, observer);
}

}  // namespace examples
