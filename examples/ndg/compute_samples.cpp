// SPDX-License-Identifier: MIT
#include "compute_samples.hpp"

namespace examples {

using namespace softtissue;

GenerationProgress compute_samples(const DatasetFolder& folder, const BodyFunction& maker,
                                   const GenerationOptions& options,
                                   const std::function<bool(const GenerationProgress&)>& observer) {
    return generate_dataset(folder, maker, options, observer);
}

}  // namespace examples
