#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace nearfit::importer {

/// Limits memory, processor time, size and number of files, and ends this process with the one that started it.
/// @param fileBytes  Size of the file to read, unpacked; larger files get more.
void limitProcess(std::uint64_t fileBytes);

/// Gives up what a reader of CAD files does not need, for good: new privileges, the network, other programs and
/// processes, all files except `readable` and what is open. As far as the kernel can.
/// @param readable  Folders and files that may still be opened, for reading.
void enterSandbox(const std::vector<std::filesystem::path>& readable);

/// Names the means that enterSandbox() finds on this machine, for people: "seccomp, Landlock 3".
std::string sandboxText();

/// Takes the limits for a small file, enters the sandbox and tries what it is to prevent. A line for each, for people and
/// tests: "memory: at most 2048 MiB", "network: refused".
std::string trySandbox();

}  // namespace nearfit::importer
