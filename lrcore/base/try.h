#pragma once
// Early returns for Result.

#include <utility>

#include "lacedring/base.hpp"

#define LR_CONCAT_(a, b) a##b
#define LR_CONCAT(a, b) LR_CONCAT_(a, b)

/// Returns from the function if the Result is an error.
#define LR_TRY(...)                                                         \
    do {                                                                    \
        if (auto lr_try_ = (__VA_ARGS__); !lr_try_) return lr_try_.error(); \
    } while (false)

/// LR_ASSIGN(auto x, f()) sets x to the value of f's Result, or returns its error from the function.
#define LR_ASSIGN(declaration, ...) LR_ASSIGN_(LR_CONCAT(lr_result_, __LINE__), declaration, __VA_ARGS__)
#define LR_ASSIGN_(name, declaration, ...) \
    auto name = (__VA_ARGS__);             \
    if (!name) return name.error();        \
    declaration = std::move(name).value()
