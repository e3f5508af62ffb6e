// Result of an operation that bad input can make fail.
#pragma once
#include <string>
#include <utility>
#include <variant>

namespace ibrdf {

enum class StatusCode {
  kOk = 0,
  kInternal = 1,       // our bug; programs exit with 1
  kInvalidInput = 2,   // the user's file or option; programs exit with 2
  kNoImprovement = 3,  // the solver could not improve on its initial guess
  kInterrupted = 130,  // stopped by the user; the best iterate was kept
};

// Ok, or a code with one line for the user that names file and field and says
// what was expected. Thread-compatible.
class [[nodiscard]] Status {
 public:
  Status() = default;
  Status(StatusCode code, std::string message)
      : code_(code), message_(std::move(message)) {}

  bool ok() const { return code_ == StatusCode::kOk; }
  StatusCode code() const { return code_; }
  int ExitCode() const { return static_cast<int>(code_); }
  const std::string& message() const { return message_; }

 private:
  StatusCode code_ = StatusCode::kOk;
  std::string message_;
};

inline Status OkStatus() { return Status(); }

// Bad input: "<where>: <what>", where = "file" or "file: field". Control
// characters, which names and quoted contents of files may hold, become '?':
// the message stays one line and cannot steer a terminal.
inline Status InvalidInput(const std::string& where, const std::string& what) {
  std::string message = where + ": " + what;
  for (char& c : message) {
    if (static_cast<unsigned char>(c) < 0x20 || c == 0x7f) c = '?';
  }
  return Status(StatusCode::kInvalidInput, std::move(message));
}

// A value or the reason why there is none. Reading the value of a failed
// StatusOr throws std::bad_variant_access: check ok() first.
template <typename T>
class [[nodiscard]] StatusOr {
 public:
  StatusOr(T value) : state_(std::move(value)) {}         // NOLINT
  StatusOr(Status status) : state_(std::move(status)) {}  // NOLINT

  bool ok() const { return std::holds_alternative<T>(state_); }
  Status status() const { return ok() ? OkStatus() : std::get<Status>(state_); }
  const T& value() const& { return std::get<T>(state_); }
  T& value() & { return std::get<T>(state_); }
  T&& value() && { return std::get<T>(std::move(state_)); }
  const T& operator*() const& { return value(); }
  T& operator*() & { return value(); }
  T&& operator*() && { return std::move(*this).value(); }
  const T* operator->() const { return &value(); }
  T* operator->() { return &value(); }

 private:
  std::variant<Status, T> state_;
};

}  // namespace ibrdf

// Returns early from a function that returns Status or StatusOr.
#define IBRDF_RETURN_IF_ERROR(expr)                \
  do {                                             \
    ::ibrdf::Status ibrdf_status_ = (expr);        \
    if (!ibrdf_status_.ok()) return ibrdf_status_; \
  } while (false)
