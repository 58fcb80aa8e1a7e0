#pragma once
// Words and numbers out of text that is in memory. Internal to lrcore/mesh.
// Lines are counted only when an error needs the number, so that reading pays nothing for it.

#include <algorithm>
#include <charconv>
#include <concepts>
#include <cstddef>
#include <limits>
#include <string_view>

namespace lr::detail {

class TextScanner {
  public:
    /// `comment` starts a comment that ends with the line (0: none). With `continuation` a line that ends in '\' goes
    /// on.
    explicit TextScanner(std::string_view text, char comment = '\0', bool continuation = false)
        : begin_(text.data()),
          at_(begin_),
          end_(begin_ + text.size()),
          comment_(comment),
          continuation_(continuation) {}

    bool at_end() const { return at_ == end_; }
    std::size_t remaining() const { return static_cast<std::size_t>(end_ - at_); }
    const char* position() const { return at_; }

    static bool is_line_end(char c) { return c == '\n' || c == '\r'; }
    static bool is_blank(char c) { return c == ' ' || c == '\t' || c == '\v' || c == '\f'; }
    static bool is_space(char c) { return is_blank(c) || is_line_end(c); }

    /// Is nothing left on this line? Call after skip_blanks().
    bool at_line_end() const { return at_ == end_ || is_line_end(*at_) || (comment_ != '\0' && *at_ == comment_); }

    void skip_blanks() {
        while (at_ != end_) {
            if (is_blank(*at_)) {
                ++at_;
            } else if (continuation_ && *at_ == '\\' && at_ + 1 != end_ && is_line_end(at_[1])) {
                at_ += (at_[1] == '\r' && end_ - at_ > 2 && at_[2] == '\n') ? 3 : 2;
            } else {
                return;
            }
        }
    }

    /// Past blanks, line ends and comments.
    void skip_space() {
        while (at_ != end_) {
            if (is_space(*at_)) {
                ++at_;
            } else if (comment_ != '\0' && *at_ == comment_) {
                skip_line();
            } else {
                return;
            }
        }
    }

    void skip_line() {
        while (at_ != end_ && !is_line_end(*at_)) ++at_;
        if (at_ != end_) ++at_;  // the second half of CRLF is an empty line
    }

    /// The characters up to the next white space; empty at the end. Call after skip_blanks() or skip_space().
    std::string_view word() {
        const char* from = at_;
        while (at_ != end_ && !is_space(*at_)) ++at_;
        if (continuation_ && at_ != from && at_ != end_ && at_[-1] == '\\') --at_;
        return {from, static_cast<std::size_t>(at_ - from)};
    }

    /// The next word of the text, or empty at its end.
    std::string_view next_word() {
        skip_space();
        return word();
    }

    /// The next word of the line, or empty at its end.
    std::string_view next_word_of_line() {
        skip_blanks();
        return at_line_end() ? std::string_view{} : word();
    }

    /// The line of a place in the text, from 1. Cost: O(text before it).
    std::size_t line_of(const char* place) const {
        const char newline = std::find(begin_, end_, '\n') == end_ ? '\r' : '\n';
        return static_cast<std::size_t>(std::count(begin_, place, newline)) + 1;
    }
    std::size_t line() const { return line_of(at_); }

  private:
    const char* begin_;
    const char* at_;
    const char* end_;
    char comment_;
    bool continuation_;
};

template <std::integral Integer>
bool parse_number(std::string_view word, Integer& out) {
    const char* from = word.data();
    const char* end = from + word.size();
    if (word.size() > 1 && *from == '+' && from[1] != '-') ++from;
    const auto [stop, error] = std::from_chars(from, end, out);
    return error == std::errc{} && stop == end && from != end;
}

/// Is the decimal number, whose value no double holds, too small rather than too big?
bool is_underflow(std::string_view word);

/// Correctly rounded, whatever the locale is. Too small a number becomes zero and too big a one infinite.
template <std::floating_point Real>
bool parse_number(std::string_view word, Real& out) {
    const char* from = word.data();
    const char* end = from + word.size();
    if (word.size() > 1 && *from == '+' && from[1] != '-') ++from;
    const auto [stop, error] = std::from_chars(from, end, out);
    if (stop != end || from == end) return false;
    if (error == std::errc::result_out_of_range) {
        out = is_underflow(word) ? Real{0} : std::numeric_limits<Real>::infinity();
        if (*from == '-') out = -out;
        return true;
    }
    return error == std::errc{};
}

}  // namespace lr::detail
