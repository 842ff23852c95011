#pragma once

#include <sys/types.h>

#include <filesystem>
#include <string>
#include <vector>

#include "models/types/result.hpp"

namespace wex {

/// Starts this program with other arguments, its output in a file. It is ended with this process.
///   arguments  without the program's name
///   errors     kInternal: no process could be started
[[nodiscard]] Result<pid_t> start_program(std::vector<std::string> arguments,
                                          const std::filesystem::path& output_file);

/// Exit code of what waitpid reports; 1 where a signal ended it.
[[nodiscard]] int exit_code_of(int wait_status) noexcept;

}  // namespace wex
