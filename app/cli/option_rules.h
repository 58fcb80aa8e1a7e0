#pragma once
// Options that have an effect only beside others: elsewhere they are wrong usage, never ignored.

#include <functional>
#include <initializer_list>
#include <string>
#include <vector>

namespace CLI {
class App;
}  // namespace CLI

namespace lacedring::app {

/// Rules between the options of one command. They are checked in the order in which they were added, when the command
/// line is parsed: call check() in the command's callback.
///
///     auto rules = std::make_shared<OptionRules>(*command);
///     rules->only_with({"--profile"}, "--format packed", [options] { return options->format == "packed"; });
///     command->callback([options, rules, &action] {
///         rules->check();
///         action = ...
class OptionRules {
  public:
    explicit OptionRules(const CLI::App& command) : command_(command) {}

    /// Each of `options`, where given, is an error unless `applies`: "--crease applies only with --view silhouette".
    /// Names of options that the command does not have (in a build without Vulkan) are passed over.
    OptionRules& only_with(std::initializer_list<const char*> options, std::string with, std::function<bool()> applies);
    /// Makes the options an error beside `other`: "--size has no effect with --no-gpu".
    OptionRules& never_with(std::initializer_list<const char*> options, const char* other);
    /// An error that says `message` where `wrong`.
    OptionRules& forbid(std::string message, std::function<bool()> wrong);

    /// Throws CLI::ValidationError, wrong usage in one line, for the first rule that is broken.
    void check() const;

  private:
    struct Rule {
        std::string option;  ///< must be given for the rule to be broken; empty: always looked at
        std::string message;
        std::function<bool()> broken;
    };

    const CLI::App& command_;
    std::vector<Rule> rules_;
};

}  // namespace lacedring::app
