#pragma once

#include <CLI/CLI.hpp>
#include <ostream>
#include <string>

#include "initializer/make_plan.hpp"
#include "models/types/result.hpp"

namespace wex::app {

/// A validator that passes what `parse` (a function from text to Result) takes.
template <typename Parse>
CLI::Validator parsed_by(Parse parse) {
  return CLI::Validator(
      [parse](std::string& text) {
        const auto value = parse(text);
        return value ? std::string() : value.error().message;
      },
      "");
}

/// Options that several commands share.
void add_machine(CLI::App& command, std::string& machine);
/// How plans are made, and what of it is switched off for a comparison.
void add_plan_settings(CLI::App& command, PlanSettings& plan);

/// Says what is wrong, on one line.
///   returns  the exit code for it
int refuse(std::ostream& err, const Error& error);

}  // namespace wex::app
