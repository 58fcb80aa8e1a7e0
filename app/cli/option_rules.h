#pragma once
// Rules for options that take effect only with certain other options. Elsewhere they are an error, never ignored.

#include <functional>
#include <initializer_list>
#include <string>
#include <vector>

namespace CLI {
class App;
}  // namespace CLI

namespace lacedring::app {

/// Rules between the options of one command, checked in the order in which they were added. Call check() in the
/// command's callback, which runs when the command line is parsed.
///
///     auto rules = std::make_shared<OptionRules>(*command);
///     rules->only_with({"--profile"}, "--format packed", [options] { return options->format == "packed"; });
///     command->callback([options, rules, &action] {
///         rules->check();
///         action = ...
class OptionRules {
  public:
    explicit OptionRules(const CLI::App& command) : command_(command) {}

    /// Makes each of `options` an error unless `applies`: "--crease applies only with --view silhouette". Ignores
    /// options that the command does not have (in a build without Vulkan).
    OptionRules& only_with(std::initializer_list<const char*> options, std::string with, std::function<bool()> applies);
    /// Makes each of `options` an error if `other` is given: "--size has no effect with --no-gpu".
    OptionRules& never_with(std::initializer_list<const char*> options, const char* other);
    /// Makes it an error, with this message, if `wrong` returns true.
    OptionRules& forbid(std::string message, std::function<bool()> wrong);

    /// Throws CLI::ValidationError with a message of one line for the first broken rule.
    void check() const;

  private:
    struct Rule {
        /// The rule is checked only if this option is given; empty: always.
        std::string option;
        std::string message;
        std::function<bool()> broken;
    };

    const CLI::App& command_;
    std::vector<Rule> rules_;
};

}  // namespace lacedring::app
