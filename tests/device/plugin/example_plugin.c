/* An example of a plug-in: a ball on a spring, one that moves by itself in a small circle. Makers may begin with it. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "device/plugin/nearfit_device.h"

struct NearfitDevice {
  double time, force[3];
  int are_forces_on;
};

static void say(char* error, size_t size, const char* text) {
  if (size == 0) return;
  strncpy(error, text, size - 1);
  error[size - 1] = '\0';
}

static int32_t count(char* error, size_t size) {
  /* A test can have it fail. */
  if (getenv("NEARFIT_EXAMPLE_FAILS") != NULL) {
    say(error, size, "the maker's service does not run");
    return -1;
  }
  return 1;
}

static int32_t describe(int32_t index, NearfitDeviceDescription* out, char* error, size_t size) {
  if (index != 0) {
    say(error, size, "there is only one");
    return 1;
  }
  memset(out, 0, sizeof *out);
  strcpy(out->name, "Example device");
  strcpy(out->serial, "0001");
  out->sensed_axes = 6;
  out->force_axes = 3;
  out->max_force = 5.0;
  out->damping = 2.0;
  out->mass = 0.1;
  return 0;
}

static NearfitDevice* open_device(int32_t index, char* error, size_t size) {
  if (index != 0) {
    say(error, size, "there is only one");
    return NULL;
  }
  return calloc(1, sizeof(NearfitDevice));
}

static void close_device(NearfitDevice* device) {
  free(device);
}

static int32_t details(NearfitDevice* device, NearfitDeviceDescription* out) {
  char ignored[64];
  (void)device;
  return describe(0, out, ignored, sizeof ignored);
}

static int32_t set_forces(NearfitDevice* device, int32_t are_on, char* error, size_t size) {
  (void)error;
  (void)size;
  device->are_forces_on = are_on;
  if (!are_on) memset(device->force, 0, sizeof device->force);
  return 0;
}

static int32_t read_pose(NearfitDevice* device, NearfitDevicePose* out) {
  memset(out, 0, sizeof *out);
  device->time += 1e-3;
  out->position[0] = 0.01 * cos(device->time);
  out->position[1] = 0.01 * sin(device->time);
  /* What it feels is seen in its height: a test looks there. */
  out->position[2] = 1e-3 * device->force[2];
  out->rotation[0] = 1.0;
  out->flags = NEARFIT_DEVICE_CALIBRATED;
  return 0;
}

static int32_t write_force(NearfitDevice* device, const double force[3], const double torque[3]) {
  (void)torque;
  if (device->are_forces_on) memcpy(device->force, force, sizeof device->force);
  return 0;
}

const NearfitDevicePlugin* nearfit_device_plugin(void) {
  static const NearfitDevicePlugin plugin = {NEARFIT_DEVICE_VERSION,
                                             sizeof(NearfitDevicePlugin),
                                             "Example plug-in",
                                             count,
                                             describe,
                                             open_device,
                                             close_device,
                                             details,
                                             set_forces,
                                             NULL, /* calibrate: it knows its pose. */
                                             NULL, /* reset: it has no faults. */
                                             NULL, /* note */
                                             NULL, /* wait: Nearfit sets the pace. */
                                             read_pose,
                                             write_force};
  return &plugin;
}
