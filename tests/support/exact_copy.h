#pragma once
// A copy in memory of exactly its size, so that a sanitizer reports reads past the end.

#include <algorithm>
#include <memory>
#include <span>

namespace lacedring::test {

template <class T>
std::unique_ptr<T[]> exact_copy(std::span<const T> from) {
    auto out = std::make_unique<T[]>(from.size());
    std::copy(from.begin(), from.end(), out.get());
    return out;
}

}  // namespace lacedring::test
