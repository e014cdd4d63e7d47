#pragma once

#include "tests/app/desktop/view_driver.h"

namespace nearfit::test {

/// A mouse over the view that points at places of the world.
class ViewPointer : public ViewDriver {
 public:
  using ViewDriver::ViewDriver;

  void click(const glm::dvec3& point) { QTest::mouseClick(&view(), Qt::LeftButton, {}, seen(point)); }
  void hover(const glm::dvec3& point) { moveTo(seen(point)); }
};

}  // namespace nearfit::test
