#include "core/import/step_request.h"

#include <functional>
#include <limits>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/base/error.h"

namespace nearfit::step_request_test {
namespace {

using testing::HasSubstr;

StepRequest example() {
  CadShape shape;
  shape.key = "bolt";
  shape.vertices = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  shape.triangles = {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}};
  StepRequest request;
  request.schema = StepSchema::Ap242;
  request.name = "fit \xC3\xA9";
  request.document.shapes = {shape, shape};
  request.document.shapes[1].key = "nut";
  CadNode node;
  node.name = "bolt 1";
  node.shape = 0;
  node.parentFromNode.rotation = {0.6, 0.0, 0.8, 0.0};
  request.document.nodes = {node};
  request.document.sha256 = std::string(64, '0');
  request.sources = {StepSource{"/home/me/bolt.step", std::string(64, 'a'), "bolt/1", 0.0254}, std::nullopt};
  return request;
}

std::vector<std::byte> bytesOf(const StepRequest& request) {
  std::vector<std::byte> bytes;
  writeStepRequest(
      request, [&](std::span<const std::byte> more) { bytes.insert(bytes.end(), more.begin(), more.end()); });
  return bytes;
}

TEST(StepRequest, IsReadBack) {
  const StepRequest read = readStepRequest(bytesOf(example()));
  EXPECT_EQ(read.schema, StepSchema::Ap242);
  EXPECT_EQ(read.name, "fit \xC3\xA9");
  ASSERT_EQ(read.sources.size(), 2U);
  ASSERT_TRUE(read.sources[0]);
  EXPECT_EQ(read.sources[0]->file, "/home/me/bolt.step");
  EXPECT_EQ(read.sources[0]->sha256, std::string(64, 'a'));
  EXPECT_EQ(read.sources[0]->key, "bolt/1");
  EXPECT_EQ(read.sources[0]->metresPerUnit, 0.0254);
  EXPECT_FALSE(read.sources[1]);
  EXPECT_EQ(read.document.shapes[1].key, "nut");
  EXPECT_EQ(read.document.nodes[0].parentFromNode.rotation.y, 0.8);
}

TEST(StepRequest, WhatContradictsItselfIsRefused) {
  const auto expectRefused = [](const std::function<void(StepRequest&)>& damage, const char* problem) {
    StepRequest request = example();
    damage(request);
    try {
      bytesOf(request);
      ADD_FAILURE() << "was not refused: " << problem;
    } catch (const Error& error) {
      EXPECT_THAT(error.problem(), HasSubstr(problem));
    }
  };
  expectRefused([](StepRequest& r) { r.name.clear(); }, "empty");
  expectRefused([](StepRequest& r) { r.name = "a\nb"; }, "no printable text");
  expectRefused([](StepRequest& r) { r.sources.pop_back(); }, "not one for each shape");
  expectRefused([](StepRequest& r) { r.sources[0]->sha256 = "12"; }, "SHA-256");
  expectRefused([](StepRequest& r) { r.sources[0]->key.clear(); }, "key");
  expectRefused([](StepRequest& r) { r.sources[0]->metresPerUnit = 0.0; }, "unit");
  expectRefused(
      [](StepRequest& r) { r.sources[0]->metresPerUnit = std::numeric_limits<double>::quiet_NaN(); }, "unit");
  expectRefused([](StepRequest& r) { r.document.nodes[0].shape = 2; }, "does not exist");
}

TEST(StepRequest, BytesThatAreCutOffOrChangedAreRefusedOrReadAsARequest) {
  const std::vector<std::byte> bytes = bytesOf(example());
  for (std::size_t size = 0; size < bytes.size(); ++size)
    EXPECT_THROW(readStepRequest(std::span(bytes).first(size)), Error) << size;
  for (std::size_t at = 0; at < bytes.size(); ++at) {
    std::vector<std::byte> changed = bytes;
    changed[at] ^= std::byte{0xFF};
    try {
      readStepRequest(changed);
    } catch (const Error& error) {
      EXPECT_FALSE(error.problem().empty());
    }
  }
}

TEST(StepRequest, AResultIsItsNotesAndTheFile) {
  std::vector<std::byte> bytes;
  writeStepNotes({"One.", "Two\x1B."}, [&](std::span<const std::byte> more) {
    bytes.insert(bytes.end(), more.begin(), more.end());
  });
  EXPECT_THROW(readStepResult(bytes), Error) << "no file";
  for (const char c : std::string("ISO-10303-21;"))
    bytes.push_back(static_cast<std::byte>(c));
  const StepResult result = readStepResult(bytes);
  EXPECT_EQ(result.notes, (std::vector<std::string>{"One.", "Two\\x1b."}));
  EXPECT_EQ(result.file.size(), 13U);
}

}  // namespace
}  // namespace nearfit::step_request_test
