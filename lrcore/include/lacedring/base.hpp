#pragma once
// Errors as values, and ids of elements.

#include <cassert>
#include <compare>
#include <cstdint>
#include <string>
#include <utility>
#include <variant>

namespace lacedring {

// Errors as values. Result<T> has the interface of std::expected<T, Error>, which g++ 12 does not offer in C++20. But
// value(), * and -> of an error are undefined behavior: check first.

enum class ErrorCode : int {
    cannot_open,       ///< the file does not exist, is a folder, or may not be read
    cannot_write,      ///< the output cannot be created or written
    malformed,         ///< the bytes do not follow their format
    unsupported,       ///< valid, but a part of the format that this reader does not support
    invalid_argument,  ///< a parameter is out of its range
    /// More elements than the representation can number or memory can hold.
    too_large,
    memory_limit,  ///< would use more memory than the caller allows
};

/// Codes from this value on are free for a program's own errors; the library never uses them.
constexpr int kFirstOwnErrorCode = 1000;

/// What went wrong. `message` is one line: the position in the file and the cause, without the file's name (the caller
/// knows it).
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

// Distinct types for the three kinds of index, so that mixing them does not compile.

/// A 32-bit index of one kind of element; Id{} is 0. Null means "none": across a border, or not found.
template <class Tag>
struct Id {
    std::uint32_t value;

    Id() = default;
    constexpr explicit Id(std::uint32_t index) : value(index) {}
    constexpr bool is_null() const { return value == UINT32_MAX; }
    friend constexpr auto operator<=>(Id, Id) = default;
};

/// The ids from 0 to size() - 1: for (const VertexId v : table.vertices()).
template <class Tag>
class IdRange {
  public:
    struct Iterator {
        std::uint32_t value;

        Id<Tag> operator*() const { return Id<Tag>(value); }
        Iterator& operator++() {
            ++value;
            return *this;
        }
        bool operator==(const Iterator&) const = default;
    };

    explicit IdRange(std::uint32_t size) : size_(size) {}
    std::uint32_t size() const { return size_; }
    Iterator begin() const { return {0}; }
    Iterator end() const { return {size_}; }

  private:
    std::uint32_t size_;
};

template <class Tag>
inline constexpr Id<Tag> kNullId{UINT32_MAX};

using VertexId = Id<struct VertexTag>;
using TriangleId = Id<struct TriangleTag>;
using CornerId = Id<struct CornerTag>;

inline constexpr VertexId kNullVertex = kNullId<VertexTag>;
inline constexpr TriangleId kNullTriangle = kNullId<TriangleTag>;
inline constexpr CornerId kNullCorner = kNullId<CornerTag>;

}  // namespace lacedring
