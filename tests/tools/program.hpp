#pragma once

#include <fcntl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

namespace wex::test {

struct ProgramOutcome {
  int exit_code = -1;
  std::string out, err;
};

inline std::string read_file(const std::filesystem::path& file) {
  std::ifstream stream(file, std::ios::binary);
  std::stringstream text;
  text << stream.rdbuf();
  return text.str();
}

/// Runs the built program in a folder. Its output goes through files beside that folder.
inline ProgramOutcome run_program(const std::filesystem::path& working_folder,
                                  std::vector<std::string> arguments) {
  arguments.insert(arguments.begin(), "wex");
  std::vector<char*> argv;
  for (std::string& argument : arguments) argv.push_back(argument.data());
  argv.push_back(nullptr);
  const std::string out_file = working_folder.string() + ".stdout";
  const std::string err_file = working_folder.string() + ".stderr";
  const pid_t pid = fork();
  if (pid == 0) {
    const int out = open(out_file.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600);
    const int err = open(err_file.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600);
    if (dup2(out, 1) < 0 || dup2(err, 2) < 0 || chdir(working_folder.c_str()) != 0) _exit(126);
    execv(WEX_PROGRAM, argv.data());
    _exit(127);
  }
  int status = 0;
  waitpid(pid, &status, 0);
  ProgramOutcome outcome{WIFEXITED(status) ? WEXITSTATUS(status) : -1, read_file(out_file),
                         read_file(err_file)};
  std::filesystem::remove(out_file);
  std::filesystem::remove(err_file);
  return outcome;
}

/// Every path below a folder, sorted.
inline std::vector<std::string> listing(const std::filesystem::path& folder) {
  std::vector<std::string> paths;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(folder)) {
    paths.push_back(entry.path().string());
  }
  std::sort(paths.begin(), paths.end());
  return paths;
}

}  // namespace wex::test
