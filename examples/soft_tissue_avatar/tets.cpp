// SPDX-License-Identifier: MIT
#include "run_avatar.hpp"

namespace examples {

template void run_avatar<Tet4>(const Settings&, const Scene&, const ThreadExecutor&, AvatarResults&);

}  // namespace examples
