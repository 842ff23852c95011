#include "models/terrain/internal/atomic_file.hpp"

#include <unistd.h>

#include <cerrno>
#include <cstdint>
#include <fstream>
#include <string>
#include <system_error>

namespace wex::terrain_internal {
namespace {

std::string last_reason() { return std::generic_category().message(errno); }

}  // namespace

Result<void> write_whole_file(const std::filesystem::path& file, std::string_view text) {
  std::filesystem::path beside = file;
  beside += ".part" + std::to_string(::getpid());
  const auto refuse = [&](const std::string& reason) {
    std::error_code ignored;
    std::filesystem::remove(beside, ignored);
    return fail(ErrorCode::kBadInput, file.string() + ": cannot be written: " + reason);
  };

  errno = 0;
  std::ofstream out(beside, std::ios::binary);
  if (!out) return refuse(last_reason());
  out.write(text.data(), static_cast<std::streamsize>(text.size()));
  out.close();
  if (!out) return refuse(last_reason());
  std::error_code renamed;
  std::filesystem::rename(beside, file, renamed);
  if (renamed) return refuse(renamed.message());
  return {};
}

Result<std::string> read_whole_file(const std::filesystem::path& file) {
  std::error_code status;
  if (!std::filesystem::exists(file, status)) {
    return fail(ErrorCode::kBadInput, file.string() + ": there is no such file");
  }
  if (!std::filesystem::is_regular_file(file, status)) {
    return fail(ErrorCode::kBadInput, file.string() + ": is a folder or device, expected a file");
  }
  errno = 0;
  std::ifstream in(file, std::ios::binary);
  const std::uintmax_t size = std::filesystem::file_size(file, status);
  if (!in || status) {
    return fail(ErrorCode::kBadInput, file.string() + ": cannot be read: " + last_reason());
  }
  std::string text(size, '\0');
  in.read(text.data(), static_cast<std::streamsize>(size));
  if (static_cast<std::uintmax_t>(in.gcount()) != size) {
    return fail(ErrorCode::kBadInput, file.string() + ": cannot be read to its end");
  }
  return text;
}

}  // namespace wex::terrain_internal
