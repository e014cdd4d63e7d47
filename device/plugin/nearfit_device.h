/* Plug-in interface of Nearfit for haptic devices, version 1: for devices whose makers allow them to be used only through
 * libraries of their own. A plug-in is a shared library that exports nearfit_device_plugin(); resources/docs/plugins.md
 * tells where Nearfit looks for it and what it promises. Plain C, so that any compiler will do.
 *
 * Units are SI; frames are right-handed, x to the right, y away from the user, z up, the origin in the middle of the workspace.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#ifndef NEARFIT_DEVICE_H
#define NEARFIT_DEVICE_H

#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

#define NEARFIT_DEVICE_VERSION 1u

/* One that is plugged in. Texts are UTF-8 and end in a zero. */
typedef struct NearfitDeviceDescription {
  char name[128];
  char serial[64];           /* Empty where there is none. */
  int32_t force_axes;        /* 0, 3 or 6. */
  int32_t has_dead_man;      /* Forces only while its switch is held. */
  double max_force;          /* [N] */
  double max_torque;         /* [N m]; 0 with three axes. */
  double damping;            /* Physical, the least over the workspace [N s/m]. */
  double rotational_damping; /* [N m s/rad] */
  double mass;               /* As felt at the handle [kg]. */
  double inertia;            /* [kg m^2] */
  double max_speed;          /* Faster is a fault [m/s]; 0: as Nearfit has it. */
} NearfitDeviceDescription;

enum { NEARFIT_DEVICE_CALIBRATED = 1, NEARFIT_DEVICE_DEAD_MAN_HELD = 2, NEARFIT_DEVICE_FAULT = 4 };

typedef struct NearfitDevicePose {
  double position[3]; /* [m] */
  double rotation[4]; /* Unit quaternion, w x y z: from the handle's axes to the device's. */
  double velocity[3]; /* [m/s] */
  double age;         /* Since it was measured [s]. */
  uint32_t buttons;   /* Bit 0 is the clutch. */
  uint32_t flags;     /* NEARFIT_DEVICE_... */
} NearfitDevicePose;

typedef struct NearfitDevice NearfitDevice; /* The plug-in's own. */

/* Functions that can fail return 0 for success, and otherwise write a sentence for the user into `error` (it ends in a zero, cut
 * off where it must be). Only `read` and `write` are called on the servo thread: they allocate nothing, take no lock that another
 * thread may hold for long, and return within 0.1 ms. All others, on one controlling thread, may take their time. */
typedef struct NearfitDevicePlugin {
  uint32_t version; /* NEARFIT_DEVICE_VERSION that it was compiled with. */
  uint32_t size;    /* sizeof(NearfitDevicePlugin) as compiled. */
  const char* name; /* Of the plug-in. */

  /* How many devices are plugged in now; < 0 for an error. */
  int32_t (*count)(char* error, size_t error_size);
  /* About the device of that index, of the last count(). */
  int32_t (*describe)(int32_t index, NearfitDeviceDescription* out, char* error, size_t error_size);
  /* Null for an error. No force until set_forces. */
  NearfitDevice* (*open)(int32_t index, char* error, size_t error_size);
  /* Forces off, closed, freed. */
  void (*close)(NearfitDevice* device);
  int32_t (*set_forces)(NearfitDevice* device, int32_t are_on, char* error, size_t error_size);
  /* The newest pose. Not 0: the device is lost. */
  int32_t (*read)(NearfitDevice* device, NearfitDevicePose* out);
  /* What the handle is to feel: force [N] and torque about its origin [N m], within the limits. Not 0: the device is lost. */
  int32_t (*write)(NearfitDevice* device, const double force[3], const double torque[3]);
} NearfitDevicePlugin;

/* The one symbol that a plug-in exports; what it returns stays valid for good. */
const NearfitDevicePlugin* nearfit_device_plugin(void);

#ifdef __cplusplus
}
#endif

#endif
