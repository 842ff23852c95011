#pragma once

#include <fcntl.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <filesystem>
#include <fstream>
#include <functional>
#include <optional>
#include <sstream>
#include <string>
#include <thread>
#include <vector>

namespace wex::test {

/// Looks every 2 ms of wall time; false if it does not come true in time.
inline bool wait_for(double patience_s, const std::function<bool()>& condition) {
  const auto end = std::chrono::steady_clock::now() + std::chrono::duration<double>(patience_s);
  while (!condition()) {
    if (std::chrono::steady_clock::now() > end) return false;
    std::this_thread::sleep_for(std::chrono::milliseconds(2));
  }
  return true;
}

/// A program that runs beside the test, its output in a file. Killed with its last owner.
class Process {
 public:
  Process(const std::string& program, std::vector<std::string> arguments,
          std::filesystem::path output_file)
      : output_file_(std::move(output_file)) {
    arguments.insert(arguments.begin(), program);
    std::vector<char*> argv;
    for (std::string& argument : arguments) argv.push_back(argument.data());
    argv.push_back(nullptr);
    pid_ = fork();
    if (pid_ == 0) {
      const int file = open(output_file_.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600);
      if (file < 0 || dup2(file, 1) < 0 || dup2(file, 2) < 0) _exit(126);
      execv(program.c_str(), argv.data());
      _exit(127);
    }
  }
  Process(const Process&) = delete;
  Process& operator=(const Process&) = delete;
  ~Process() {
    if (exit_code_ || pid_ < 0) return;
    kill(pid_, SIGKILL);
    waitpid(pid_, nullptr, 0);
  }

  void send(int signal) const { kill(pid_, signal); }
  /// Exit code, 128 + signal if one ended it; nullopt: still running.
  std::optional<int> poll() {
    int status = 0;
    if (!exit_code_ && waitpid(pid_, &status, WNOHANG) == pid_) {
      exit_code_ = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
    }
    return exit_code_;
  }
  /// -1: still running.
  int wait(double patience_s) {
    return wait_for(patience_s, [&] { return poll().has_value(); }) ? *exit_code_ : -1;
  }
  [[nodiscard]] std::string output() const {
    std::ifstream stream(output_file_, std::ios::binary);
    std::stringstream text;
    text << stream.rdbuf();
    return text.str();
  }

 private:
  std::filesystem::path output_file_;
  pid_t pid_ = -1;
  std::optional<int> exit_code_;
};

}  // namespace wex::test
