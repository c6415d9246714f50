#include <softtissue/core/executor.hpp>

#include <stdexcept>
#include <utility>
#include <vector>

#include <doctest/doctest.h>

using namespace softtissue;

namespace {

/// A user's executor: one range an index, last first.
struct Backwards {
    template <class Body>
    void for_each_range(Index count, const Body& body) const {
        for (Index i = count; i-- > 0;) {
            body(i, i + 1);
        }
    }
};

struct NotConst {
    template <class Body>
    void for_each_range(Index, const Body&) {}
};

struct ReturnsSomething {
    template <class Body>
    int for_each_range(Index, const Body&) const {
        return 0;
    }
};

}  // namespace

static_assert(Executor<SequentialExecutor> && Executor<Backwards>);
static_assert(!Executor<NotConst> && !Executor<ReturnsSomething> && !Executor<int>);

TEST_CASE("the sequential executor hands over the whole range at once") {
    std::vector<std::pair<Index, Index>> ranges;
    const auto body = [&](Index begin, Index end) { ranges.emplace_back(begin, end); };
    SequentialExecutor{}.for_each_range(5, body);
    CHECK(ranges == std::vector<std::pair<Index, Index>>{{0, 5}});
}

TEST_CASE("an empty or negative range calls nothing") {
    const auto body = [](Index, Index) { throw std::logic_error("called"); };
    CHECK_NOTHROW(SequentialExecutor{}.for_each_range(0, body));
    CHECK_NOTHROW(SequentialExecutor{}.for_each_range(-1, body));
}

TEST_CASE("an exception of the body reaches the caller") {
    const auto body = [](Index, Index) { throw std::runtime_error("from the body"); };
    CHECK_THROWS_WITH_AS(SequentialExecutor{}.for_each_range(1, body), "from the body", std::runtime_error);
}
