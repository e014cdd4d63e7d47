#include "core/session/scene_events.h"

#include <functional>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "core/session/session.h"

namespace nearfit::scene_events_test {
namespace {

using Stage = SceneEvents::Stage;
constexpr Stage kStages[] = {Stage::Model, Stage::View, Stage::Panels, Stage::Application};

/// Writes down who is told.
struct Log {
  std::function<void()> add(const char* name) {
    return [this, name] { told += name; };
  }
  /// Notifies once and returns what the listeners said, in their order.
  std::string of(SceneEvents& events) {
    told.clear();
    events.notify();
    return told;
  }
  std::string told;
};

TEST(SceneEvents, StagesAreToldInOrderHoweverTheySubscribed) {
  SceneEvents events;
  Log log;
  const Subscription servo = events.subscribe(Stage::Application, log.add("a"));
  const Subscription panel = events.subscribe(Stage::Panels, log.add("p"));
  const Subscription model = events.subscribe(Stage::Model, log.add("m"));
  const Subscription tool = events.subscribe(Stage::Panels, log.add("q"));
  const Subscription view = events.subscribe(Stage::View, log.add("v"));
  EXPECT_EQ(log.of(events), "mvpqa");
  EXPECT_EQ(log.of(events), "mvpqa");
}

TEST(SceneEvents, ASubscriptionEndsWithItsOwnerOnce) {
  SceneEvents events;
  Log log;
  Subscription kept = events.subscribe(Stage::View, log.add("k"));
  {
    const Subscription brief = events.subscribe(Stage::View, log.add("b"));
    EXPECT_EQ(log.of(events), "kb");
  }
  EXPECT_EQ(log.of(events), "k");
  Subscription moved = std::move(kept);
  EXPECT_EQ(log.of(events), "k");
  moved = events.subscribe(Stage::View, log.add("n"));
  EXPECT_EQ(log.of(events), "n") << "the one assigned over has ended";
  moved.end();
  moved.end();
  EXPECT_EQ(log.of(events), "");
}

TEST(SceneEvents, WhatAListenerHoldsIsFreedWithItsSubscription) {
  SceneEvents events;
  const auto held = std::make_shared<int>(0);
  Subscription subscription = events.subscribe(Stage::Model, [held] { ++*held; });
  EXPECT_EQ(held.use_count(), 2);
  subscription.end();
  EXPECT_EQ(held.use_count(), 1);
}

TEST(SceneEvents, ASubscriptionMayOutliveWhatItListensTo) {
  auto events = std::make_unique<SceneEvents>();
  Subscription subscription = events->subscribe(Stage::Model, [] {});
  events.reset();
  subscription.end();
}

TEST(SceneEvents, WhoIsEndedDuringANotificationIsNotToldAnyMore) {
  for (const Stage stage : kStages) {
    SceneEvents events;
    Log log;
    Subscription other;
    const Subscription first = events.subscribe(Stage::Model, [&] { other.end(); });
    other = events.subscribe(stage, log.add("o"));
    const Subscription last = events.subscribe(Stage::Application, log.add("l"));
    EXPECT_EQ(log.of(events), "l");
  }
}

TEST(SceneEvents, AListenerMayEndItself) {
  SceneEvents events;
  Log log;
  std::optional<Subscription> self;
  self = events.subscribe(Stage::Model, [&, name = std::string("self")] {
    self.reset();
    log.told += name;  // Not freed while it runs.
  });
  const Subscription next = events.subscribe(Stage::Model, log.add("n"));
  EXPECT_EQ(log.of(events), "selfn");
  EXPECT_EQ(log.of(events), "n");
}

TEST(SceneEvents, WhoSubscribesDuringANotificationHearsOfTheNextChange) {
  for (const Stage stage : kStages) {
    SceneEvents events;
    Log log;
    std::vector<Subscription> later;
    const Subscription first = events.subscribe(Stage::View, [&] {
      if (later.size() < 50) later.push_back(events.subscribe(stage, log.add("x")));
    });
    EXPECT_EQ(log.of(events), "");
    EXPECT_EQ(log.of(events), "x");
    EXPECT_EQ(log.of(events), "xx");
  }
}

// Before there were stages, a listener could find a part selected that had left the scene.
TEST(SceneEvents, AChangeByAListenerIsToldFromTheFirstStageOnAndTheOldOneNoFurther) {
  Session session;
  std::size_t partsInModel = 0;
  std::string told;
  const auto tell = [&](char name) {
    EXPECT_EQ(partsInModel, session.scene().parts().size()) << "to " << name;
    told += name;
  };
  const Subscription servo = session.onChange(Stage::Application, [&] { tell('a'); });
  const Subscription before = session.onChange(Stage::View, [&] { tell('v'); });
  const Subscription changer = session.onChange(Stage::View, [&] {
    tell('c');
    if (session.scene().parts().size() < 3) session.addPart({}, "Another");
  });
  const Subscription after = session.onChange(Stage::View, [&] { tell('w'); });
  const Subscription model = session.onChange(Stage::Model, [&] {
    partsInModel = session.scene().parts().size();
    tell('m');
  });
  session.addPart({}, "Peg");
  EXPECT_EQ(session.scene().parts().size(), 3U);
  EXPECT_EQ(told, "mvcmvcmvcwa");
  told.clear();
  session.undo();
  EXPECT_EQ(told, "mvcmvcwa") << "the next change is told as usual";
}

TEST(SceneEvents, WhoIsEndedByAnInnerChangeIsNotToldOfIt) {
  Session session;
  int calls = 0;
  Subscription changer;
  changer = session.onChange(Stage::View, [&] {
    ++calls;
    session.addPart({}, "Another");
  });
  // The listener is running when its subscription ends.
  const Subscription model = session.onChange(Stage::Model, [&] {
    if (session.scene().parts().size() > 1) changer.end();
  });
  session.addPart({}, "Peg");
  EXPECT_EQ(calls, 1);
  EXPECT_EQ(session.scene().parts().size(), 2U);
}

TEST(SceneEvents, AfterAListenerHasThrownTheNextChangeIsToldToAll) {
  SceneEvents events;
  Log log;
  bool isFaulty = true;
  const Subscription faulty = events.subscribe(Stage::Model, [&] {
    if (isFaulty) throw std::runtime_error("no");
  });
  const Subscription view = events.subscribe(Stage::View, log.add("v"));
  EXPECT_THROW(events.notify(), std::runtime_error);
  EXPECT_EQ(log.told, "");
  isFaulty = false;
  EXPECT_EQ(log.of(events), "v");
}

}  // namespace
}  // namespace nearfit::scene_events_test
