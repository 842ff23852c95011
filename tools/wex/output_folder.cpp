#include "tools/wex/output_folder.hpp"

#include <unistd.h>

#include <fstream>

namespace wex::app {
namespace fs = std::filesystem;
namespace {

/// Beside the final name, same extension (some writers choose the format by it).
fs::path temporary_name(const fs::path& file) {
  std::string name = ".";
  name += file.stem().string();
  name += ".";
  name += std::to_string(getpid());
  name += file.extension().string();
  return file.parent_path() / name;
}

Result<void> write_plain(const fs::path& file, const std::string& text) {
  std::ofstream stream(file, std::ios::binary);
  stream.write(text.data(), static_cast<std::streamsize>(text.size()));
  stream.close();
  if (!stream) return fail(ErrorCode::kBadInput, "cannot write " + file.string());
  return {};
}

Result<void> write_and_rename(const fs::path& file,
                              const std::function<Result<void>(const fs::path&)>& write) {
  const fs::path temporary = temporary_name(file);
  Result<void> written = write(temporary);
  std::error_code error;
  if (written) {
    fs::rename(temporary, file, error);
    if (!error) return {};
    written = fail(ErrorCode::kBadInput, "cannot write " + file.string() + ": " + error.message());
  }
  fs::remove(temporary, error);
  return written;
}

}  // namespace

Result<OutputFolder> OutputFolder::open(const fs::path& folder) {
  OutputFolder out;
  out.folder_ = folder;
  const auto refuse = [&](const std::string& reason) {
    return fail(ErrorCode::kBadInput,
                "output folder " + folder.string() + " cannot be written: " + reason);
  };
  if (folder.empty()) return refuse("its name is empty");
  fs::path partial;
  for (const fs::path& part : fs::absolute(folder).lexically_normal()) {
    partial /= part;
    std::error_code error;
    if (fs::is_directory(partial, error)) continue;
    if (fs::exists(partial, error)) return refuse(partial.string() + " is not a folder");
    if (!fs::create_directory(partial, error) && error) return refuse(error.message());
    if (!error) out.created_.push_back(partial);
  }
  const fs::path probe = folder / (".wex-probe-" + std::to_string(getpid()));
  const bool writable = write_plain(probe, "probe\n").has_value();
  std::error_code error;
  fs::remove(probe, error);
  if (!writable) return refuse("no file can be created in it");
  return out;
}

OutputFolder::OutputFolder(OutputFolder&& other) noexcept
    : folder_(std::move(other.folder_)), created_(std::move(other.created_)) {
  other.created_.clear();
}

OutputFolder::~OutputFolder() {
  // remove() refuses folders with content, so only what is still empty disappears.
  for (auto folder = created_.rbegin(); folder != created_.rend(); ++folder) {
    std::error_code ignored;
    fs::remove(*folder, ignored);
  }
}

void OutputFolder::remove_stale(const std::vector<std::string>& names) const {
  for (const std::string& name : names) {
    std::error_code ignored;
    fs::remove_all(folder_ / name, ignored);
  }
}

Result<void> OutputFolder::publish(
    const std::string& name, const std::function<Result<void>(const fs::path&)>& write) const {
  const fs::path file = folder_ / name;
  std::error_code error;
  fs::create_directories(file.parent_path(), error);
  if (error)
    return fail(ErrorCode::kBadInput, "cannot write " + file.string() + ": " + error.message());
  return write_and_rename(file, write);
}

Result<void> OutputFolder::publish_text(const std::string& name, const std::string& text) const {
  return publish(name, [&](const fs::path& file) { return write_plain(file, text); });
}

Result<void> write_text_file(const fs::path& file, const std::string& text) {
  const fs::path parent = file.parent_path();
  std::error_code error;
  if (!parent.empty() && !fs::is_directory(parent, error)) {
    return fail(ErrorCode::kBadInput,
                "cannot write " + file.string() + ": " + parent.string() + " is not a folder");
  }
  return write_and_rename(file,
                          [&](const fs::path& temporary) { return write_plain(temporary, text); });
}

}  // namespace wex::app
