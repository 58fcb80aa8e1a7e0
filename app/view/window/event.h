#pragma once
// Events of a window. They come from GLFW (window.h) or from scripts (script.h).

#include <cstdint>
#include <string>
#include <vector>

namespace lacedring::view {

/// Letters, digits and punctuation are their upper-case ASCII characters.
enum Key : int {
    key_escape = 256,
    key_enter = 257,
    key_tab = 258,
    key_backspace = 259,
    key_delete = 261,
    key_right = 262,
    key_left = 263,
    key_down = 264,
    key_up = 265,
    key_page_up = 266,
    key_page_down = 267,
    key_home = 268,
    key_end = 269,
    key_f1 = 290,
    key_f5 = 294,
    key_f12 = 301,
};

enum Modifier : unsigned { mod_shift = 1, mod_control = 2, mod_alt = 4 };

/// x and y are a position in pixels from the window's upper left corner, a size (resize), or steps (scroll).
struct Event {
    enum Kind { key, text, move, button, scroll, drop, resize, close, refresh } kind = refresh;
    /// A Key, a mouse button (0 left, 1 right, 2 middle), or a Unicode character.
    int code = 0;
    bool down = false;
    unsigned modifiers = 0;
    double x = 0, y = 0;
    std::vector<std::string> paths = {};
};

}  // namespace lacedring::view
