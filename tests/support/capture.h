#pragma once
// CAPTURE for structured bindings, which lambdas of clang 14 (and so doctest's macros) cannot name.

#include <doctest/doctest.h>

#define CAPTURE_COPY(binding)                \
    const auto captured_##binding = binding; \
    INFO(#binding " := ", captured_##binding)
