#pragma once
// Scans words and numbers of a text in memory. Internal to lrio.
// Lines are counted only when an error message needs the number, so that reading is not slowed down.

#include <algorithm>
#include <array>
#include <charconv>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <limits>
#include <string_view>

namespace lacedring::detail {

/// Microsoft's C library writes numbers that are not finite as "1.#INF", "1.#QNAN" etc. Returns the length of such a
/// number from the '#' on, or 0. `before` is the text before the '#'.
inline std::size_t msvc_tail(std::string_view before, std::string_view from_hash) {
    if (!before.ends_with("1.")) return 0;
    for (const std::string_view name : {"#INF", "#IND", "#QNAN", "#SNAN"}) {
        if (from_hash.size() < name.size()) continue;
        const auto same = [](char a, char b) { return (a >= 'a' && a <= 'z' ? a - 'a' + 'A' : a) == b; };
        if (std::equal(name.begin(), name.end(), from_hash.begin(), [&](char b, char a) { return same(a, b); })) {
            return name.size();
        }
    }
    return 0;
}

/// Removes a UTF-8 byte-order mark from the beginning.
inline std::string_view without_byte_order_mark(std::string_view text) {
    return text.starts_with("\xEF\xBB\xBF") ? text.substr(3) : text;
}

class TextScanner {
  public:
    /// With `comments`, a '#' starts a comment up to the line's end, even directly after a word. With `continuation`, a
    /// '\\' at a line's end continues the line, except in a comment; blanks may follow the '\\'.
    explicit TextScanner(std::string_view text, bool comments = false, bool continuation = false)
        : begin_(text.data()),
          at_(begin_),
          end_(begin_ + text.size()),
          ends_line_(static_cast<std::uint8_t>(line_end | (comments ? hash : 0))),
          ends_word_(static_cast<std::uint8_t>(ends_line_ | blank | (continuation ? backslash : 0))) {}

    bool at_end() const { return at_ == end_; }
    std::size_t remaining() const { return static_cast<std::size_t>(end_ - at_); }
    const char* position() const { return at_; }
    void skip_bytes(std::size_t count) { at_ += std::min(count, remaining()); }

    static bool is_space(char c) { return is(c, blank | line_end); }

    /// Is the rest of the line empty? Call after skip_blanks().
    bool at_line_end() const { return at_ == end_ || is(*at_, ends_line_); }

    void skip_blanks() {
        const char* at = at_;
        while (at != end_ && is(*at, blank)) ++at;
        at_ = at;
        if (at != end_ && is(*at, backslash & ends_word_)) skip_continuations();
    }

    /// Skips blanks. True: nothing else is left on the line.
    bool skip_to_line_end() {
        skip_blanks();
        return at_line_end();
    }

    /// Skips blanks, line ends and comments.
    void skip_space() {
        while (true) {
            const char* at = at_;
            while (at != end_ && is_space(*at)) ++at;
            at_ = at;
            if (at == end_ || !is(*at, ends_line_)) return;
            skip_line();
        }
    }

    void skip_line() {
        const char* at = at_;
        while (at != end_ && !is(*at, line_end)) ++at;
        at_ = at == end_ ? at : at + 1;  // the LF of CRLF is skipped later as an empty line
    }

    /// Skips the rest of the line and its continuation lines.
    void skip_statement() {
        while (!skip_to_line_end()) word();
        skip_line();
    }

    /// The characters up to the next white space or comment; empty at the end. Call after skip_blanks() or
    /// skip_space().
    std::string_view word() {
        const char* from = at_;
        const char* at = from;
        while (at != end_ && !is(*at, ends_word_)) ++at;
        at_ = at;
        return at == end_ || is_space(*at) ? view(from, at) : rest_of_word(from);
    }

    /// The next word of the text, or empty at its end.
    std::string_view next_word() {
        skip_space();
        return word();
    }

    /// The next word of the line, or empty at its end.
    std::string_view next_word_of_line() {
        const char* from = at_;
        while (from != end_ && is(*from, blank)) ++from;
        at_ = from;
        if (from == end_) return {};
        const char* at = from;
        while (at != end_ && !is(*at, ends_word_)) ++at;
        if (at != from && (at == end_ || is_space(*at))) {  // the usual case, which takes most of the time
            at_ = at;
            return view(from, at);
        }
        return skip_to_line_end() ? std::string_view{} : word();
    }

    /// The rest of the line up to a comment, without the blanks around it.
    std::string_view rest_of_line() {
        const std::string_view first = next_word_of_line();
        std::string_view last = first;
        for (std::string_view next = first; !next.empty(); next = next_word_of_line()) last = next;
        return view(first.data(), last.data() + last.size());
    }

    /// The line number of a position in the text, from 1. Cost: O(text before it).
    std::size_t line_of(const char* place) const {
        const char newline = std::find(begin_, end_, '\n') == end_ ? '\r' : '\n';
        return static_cast<std::size_t>(std::count(begin_, place, newline)) + 1;
    }
    std::size_t line() const { return line_of(at_); }

  private:
    enum Class : std::uint8_t { blank = 1, line_end = 2, hash = 4, backslash = 8 };

    static constexpr std::array<std::uint8_t, 256> classes = [] {
        std::array<std::uint8_t, 256> out{};
        for (const char c : {' ', '\t', '\v', '\f'}) out[static_cast<std::uint8_t>(c)] = blank;
        for (const char c : {'\n', '\r'}) out[static_cast<std::uint8_t>(c)] = line_end;
        out['#'] = hash;
        out['\\'] = backslash;
        return out;
    }();

    static bool is(char c, int any_of) { return (classes[static_cast<std::uint8_t>(c)] & any_of) != 0; }
    static std::string_view view(const char* from, const char* to) {
        return {from, static_cast<std::size_t>(to - from)};
    }

    /// The beginning of the next line if the '\\' at `at` continues the line, else null.
    const char* continued(const char* at) const {
        if (!is(*at, backslash & ends_word_)) return nullptr;
        ++at;
        while (at != end_ && is(*at, blank)) ++at;
        if (at == end_ || !is(*at, line_end)) return nullptr;
        return at + ((*at == '\r' && end_ - at > 1 && at[1] == '\n') ? 2 : 1);
    }

    void skip_continuations() {
        while (at_ != end_) {
            const char* next = is(*at_, blank) ? at_ + 1 : continued(at_);
            if (next == nullptr) return;
            at_ = next;
        }
    }

    /// Ends the word that begins at `from`; at_ is at a '\\' or '#', which may or may not end the word.
    std::string_view rest_of_word(const char* from) {
        for (; at_ != end_ && !is_space(*at_) && continued(at_) == nullptr; ++at_) {
            if (!is(*at_, hash & ends_line_)) continue;
            const std::size_t tail = msvc_tail(view(from, at_), view(at_, end_));
            if (tail == 0) break;
            at_ += tail - 1;
        }
        return view(from, at_);
    }

    const char* begin_;
    const char* at_;
    const char* end_;
    std::uint8_t ends_line_;  // sets of Class
    std::uint8_t ends_word_;
};

template <std::integral Integer>
bool parse_number(std::string_view word, Integer& out) {
    const char* from = word.data();
    const char* end = from + word.size();
    if (word.size() - 1 < 9) {  // fast path: up to 9 digits cannot overflow 32 bits
        std::uint32_t value = 0;
        while (from != end && static_cast<unsigned char>(*from - '0') < 10) {
            value = value * 10 + static_cast<std::uint32_t>(*from++ - '0');
        }
        if (from == end) {
            out = static_cast<Integer>(value);
            return static_cast<std::uint64_t>(value) <= static_cast<std::uint64_t>(std::numeric_limits<Integer>::max());
        }
        from = word.data();
    }
    if (word.size() > 1 && *from == '+' && from[1] != '-') ++from;
    const auto [stop, error] = std::from_chars(from, end, out);
    return error == std::errc{} && stop == end && from != end;
}

/// Is the decimal number, which is out of the range of doubles, too small rather than too large?
bool is_underflow(std::string_view word);

/// Parses Microsoft's "1.#INF", "-1.#IND", "1.#QNAN" and "1.#SNAN", which std::from_chars does not read. Zeros and an
/// exponent may follow.
template <std::floating_point Real>
bool parse_msvc(std::string_view word, Real& out) {
    const std::size_t hash = word.find('#');
    if (hash == std::string_view::npos) return false;
    std::string_view before = word.substr(0, hash);
    const bool negative = before.starts_with('-');
    if (negative || before.starts_with('+')) before.remove_prefix(1);
    const std::size_t tail = before == "1." ? msvc_tail(before, word.substr(hash)) : 0;
    if (tail == 0) return false;
    std::string_view rest = word.substr(hash + tail);
    rest.remove_prefix(std::min(rest.find_first_not_of('0'), rest.size()));
    if (!rest.empty()) {
        rest.remove_prefix(1);
        if ((word[word.size() - rest.size() - 1] | 0x20) != 'e' || rest.empty()) return false;
        if (rest[0] == '-' || rest[0] == '+') rest.remove_prefix(1);
        if (rest.empty() || rest.find_first_not_of("0123456789") != std::string_view::npos) return false;
    }
    const char third = word[hash + 3];  // 'F' only in "#INF"
    const bool infinite = tail == 4 && (third == 'F' || third == 'f');
    out = infinite ? std::numeric_limits<Real>::infinity() : std::numeric_limits<Real>::quiet_NaN();
    if (negative) out = -out;
    return true;
}

/// Parses a number with correct rounding, independent of the locale. Underflow gives zero, overflow infinity.
template <std::floating_point Real>
bool parse_number(std::string_view word, Real& out) {
    const char* from = word.data();
    const char* end = from + word.size();
    if (word.size() > 1 && *from == '+' && from[1] != '-') ++from;
    const auto [stop, error] = std::from_chars(from, end, out);
    if (from == end) return false;
    if (stop != end) return parse_msvc(word, out);
    if (error == std::errc::result_out_of_range) {
        out = is_underflow(word) ? Real{0} : std::numeric_limits<Real>::infinity();
        if (*from == '-') out = -out;
        return true;
    }
    return error == std::errc{};
}

}  // namespace lacedring::detail
