#include "core/base/error.h"

#include <utility>

namespace nearfit {
namespace {

std::string compose(const std::string& where, const std::string& problem, const std::string& remedy) {
  std::string text = where.empty() ? problem : where + ": " + problem;
  if (!remedy.empty()) text += "; " + remedy;
  return text;
}

}  // namespace

Error::Error(std::string where, std::string problem, std::string remedy)
    : std::runtime_error(compose(where, problem, remedy)),
      where_(std::move(where)),
      problem_(std::move(problem)),
      remedy_(std::move(remedy)) {}

bool isCancelled(const std::exception_ptr& error) {
  try {
    if (error) std::rethrow_exception(error);
  } catch (const Cancelled&) {
    return true;
  } catch (...) {
  }
  return false;
}

}  // namespace nearfit
