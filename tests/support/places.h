#pragma once

#include <filesystem>
#include <string>

namespace nearfit::test {

// Functions of one file rather than macros for all: with the paths of a work tree in each command line, a compiler's
// cache could not give what it has to another work tree.

/// Absolute path of the tree that is tested.
std::filesystem::path sourceFolder();

/// Absolute path of the folder of models beside that tree; it may be missing.
std::filesystem::path sharedFolder();

/// Absolute path of a program, or of another file, in the folder that the running test lies in. It may be missing.
std::string builtPath(const std::string& name);

}  // namespace nearfit::test
