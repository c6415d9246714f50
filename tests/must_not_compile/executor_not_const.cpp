// Executors are shared, so their loops are const.
// expect: executor\.for_each_range\(count, body\)
#include <softtissue/core/executor.hpp>

struct NotConst {
    template <class Body>
    void for_each_range(softtissue::Index, const Body&) {}
};

template <softtissue::Executor E>
void use(const E&) {}

int main() { use(NotConst{}); }
