#include "ibrdf/io/atomic_file.h"

#include <fcntl.h>
#include <signal.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cctype>
#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <system_error>

namespace ibrdf {
namespace {

Status SystemError(const std::string& path, const std::string& what) {
  return InvalidInput(path, what + " (" + std::strerror(errno) + ")");
}

Status Flush(const std::string& path) {
  const int fd = ::open(path.c_str(), O_RDONLY | O_CLOEXEC);
  if (fd < 0) return SystemError(path, "cannot reopen the written file");
  const int rc = ::fsync(fd);
  ::close(fd);
  if (rc != 0) return SystemError(path, "cannot flush the written file");
  return OkStatus();
}

// The prefix names this machine: process numbers of others in a shared folder
// mean nothing.
std::string TemporaryPrefix() {
  char host[256] = {};
  ::gethostname(host, sizeof(host) - 1);
  std::string prefix = ".tmp-";
  for (const char* c = host; *c != '\0'; ++c) {
    if (std::isalnum(static_cast<unsigned char>(*c)) != 0) prefix += *c;
  }
  return prefix + "-";
}

// What writers of the same file left that were killed on this machine.
void RemoveLeftovers(const std::string& folder, const std::string& name) {
  namespace fs = std::filesystem;
  const std::string prefix = TemporaryPrefix(), suffix = "-" + name;
  std::error_code ignored;
  fs::directory_iterator entry(folder.empty() ? "." : folder, ignored);
  while (!ignored && entry != fs::directory_iterator()) {
    const std::string file = entry->path().filename().string();
    if (file.size() > prefix.size() + suffix.size() &&
        file.compare(0, prefix.size(), prefix) == 0 &&
        file.compare(file.size() - suffix.size(), suffix.size(), suffix) == 0) {
      const std::string number = file.substr(
          prefix.size(), file.size() - prefix.size() - suffix.size());
      char* end = nullptr;
      const long pid = std::strtol(number.c_str(), &end, 10);
      if (*end == '\0' && pid > 0 && ::kill(static_cast<pid_t>(pid), 0) != 0 &&
          errno == ESRCH) {
        std::remove(entry->path().c_str());
      }
    }
    entry.increment(ignored);
  }
}

}  // namespace

Status WriteAtomically(const std::string& path,
                       const std::function<Status(const std::string&)>& write) {
  const size_t slash = path.find_last_of('/');
  const size_t base = slash == std::string::npos ? 0 : slash + 1;
  const std::string folder = path.substr(0, base), name = path.substr(base);
  RemoveLeftovers(folder, name);
  // The extension stays last: some writers choose the format by it.
  const std::string temporary =
      folder + TemporaryPrefix() + std::to_string(::getpid()) + "-" + name;
  Status status;
  try {
    status = write(temporary);
  } catch (...) {  // no memory
    std::remove(temporary.c_str());
    throw;
  }
  if (status.ok()) status = Flush(temporary);
  if (status.ok() && std::rename(temporary.c_str(), path.c_str()) != 0) {
    status = SystemError(path, "cannot rename the temporary file");
  }
  if (!status.ok()) std::remove(temporary.c_str());
  return status;
}

Status WriteFileAtomically(const std::string& path, const std::string& bytes) {
  return WriteAtomically(path, [&](const std::string& temporary) {
    std::FILE* file = std::fopen(temporary.c_str(), "wb");
    if (file == nullptr) return SystemError(path, "cannot write");
    const bool written =
        std::fwrite(bytes.data(), 1, bytes.size(), file) == bytes.size();
    const bool closed = std::fclose(file) == 0;
    if (!written || !closed) return SystemError(path, "cannot write");
    return OkStatus();
  });
}

StatusOr<std::string> ReadFile(const std::string& path, size_t max_bytes) {
  std::FILE* file = std::fopen(path.c_str(), "rb");
  if (file == nullptr) return SystemError(path, "cannot open");
  struct stat info = {};
  if (::fstat(::fileno(file), &info) != 0 || !S_ISREG(info.st_mode)) {
    std::fclose(file);
    return InvalidInput(path, "expected a regular file");
  }
  const size_t size = static_cast<size_t>(info.st_size);
  if (size > max_bytes) {
    std::fclose(file);
    return InvalidInput(path, "file has " + std::to_string(size) +
                                  " bytes, expected at most " +
                                  std::to_string(max_bytes));
  }
  std::string bytes(size, '\0');
  const size_t got = std::fread(bytes.data(), 1, size, file);
  std::fclose(file);
  if (got != size) return InvalidInput(path, "cannot read the whole file");
  return bytes;
}

}  // namespace ibrdf
