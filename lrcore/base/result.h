#pragma once
// Errors as values. Result<T> has the names of std::expected<T, Error>, which g++ 12 does not offer in C++20.

#include <cassert>
#include <string>
#include <utility>
#include <variant>

namespace lr {

enum class ErrorCode {
    cannot_open,       ///< the file does not exist, is a folder, or may not be read
    cannot_write,      ///< the output cannot be made
    malformed,         ///< the bytes do not follow their format
    unsupported,       ///< the format is right, but this part of it is not read here
    invalid_argument,  ///< a parameter is out of its range
    too_large,         ///< more elements than the representation numbers, or than memory holds
    memory_limit,      ///< would take more memory than the caller allows
    no_device,         ///< no usable Vulkan device, or it lacks what was asked for: memory, sizes, features
    device_failure,    ///< a Vulkan call failed
};

/// What went wrong. `message` is one line: the place and the cause, without the file's name (the caller knows it).
struct Error {
    ErrorCode code;
    std::string message;
};

template <class T>
class [[nodiscard]] Result {
  public:
    Result(T value) : state_(std::in_place_index<0>, std::move(value)) {}
    Result(Error error) : state_(std::in_place_index<1>, std::move(error)) {}

    bool has_value() const noexcept { return state_.index() == 0; }
    explicit operator bool() const noexcept { return has_value(); }

    T& value() & { return *get(); }
    const T& value() const& { return *get(); }
    T&& value() && { return std::move(*get()); }
    T& operator*() & { return *get(); }
    const T& operator*() const& { return *get(); }
    T&& operator*() && { return std::move(*get()); }
    T* operator->() { return get(); }
    const T* operator->() const { return get(); }

    const Error& error() const {
        assert(!has_value());
        return *std::get_if<1>(&state_);
    }

  private:
    T* get() {
        assert(has_value());
        return std::get_if<0>(&state_);
    }
    const T* get() const {
        assert(has_value());
        return std::get_if<0>(&state_);
    }
    std::variant<T, Error> state_;
};

template <>
class [[nodiscard]] Result<void> {
  public:
    Result() = default;
    Result(Error error) : error_(std::move(error)), failed_(true) {}

    bool has_value() const noexcept { return !failed_; }
    explicit operator bool() const noexcept { return !failed_; }
    const Error& error() const {
        assert(failed_);
        return error_;
    }

  private:
    Error error_{};
    bool failed_ = false;
};

}  // namespace lr
