#pragma once
// REQUIRE for loops over every corner: a doctest assertion takes ten times as long as most conditions.

#include <doctest/doctest.h>

/// Requires a condition. If it fails, it is computed again for doctest to print its values.
#define REQUIRE_FAST(...)                                       \
    do {                                                        \
        if (!(__VA_ARGS__)) {                                   \
            REQUIRE(__VA_ARGS__);                               \
            FAIL("holds, but did not at first: " #__VA_ARGS__); \
        }                                                       \
    } while (false)

/// REQUIRE_FAST that prints the property which fails.
#define REQUIRE_PROPERTY(property, ...) \
    do {                                \
        if (!(__VA_ARGS__)) {           \
            INFO(property);             \
            REQUIRE_FAST(__VA_ARGS__);  \
        }                               \
    } while (false)
