#pragma once
// REQUIRE for loops over every corner: doctest takes ten times as long as what it checks.

#include <doctest/doctest.h>

/// A condition that does not hold is computed again, for doctest to print its values.
#define REQUIRE_FAST(...)                                       \
    do {                                                        \
        if (!(__VA_ARGS__)) {                                   \
            REQUIRE(__VA_ARGS__);                               \
            FAIL("holds, but did not at first: " #__VA_ARGS__); \
        }                                                       \
    } while (false)
