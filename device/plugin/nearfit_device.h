/* Plug-in interface of Nearfit for haptic devices, version 1.
 *
 * It is for devices whose makers allow their use only through libraries of their own. A plug-in is a shared
 * library that exports nearfit_device_plugin(). resources/docs/plugins.md says where Nearfit looks for it.
 * Plain C, so that any compiler will do.
 *
 * Units are SI. Frames are right-handed: x to the right, y away from the user, z up; the origin is in the
 * middle of the workspace.
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

/* A device that is plugged in. All numbers are finite and >= 0; texts are UTF-8 and end in a zero byte. */
typedef struct NearfitDeviceDescription {
  char name[128];            /* Shown to the user. */
  char serial[64];           /* Serial number; empty if it has none. */
  int32_t force_axes;        /* Axes that it can push along: 0 (no force), 3 or 6 (force and torque). */
  int32_t has_dead_man;      /* Not 0: Nearfit sends forces only while the dead-man switch is held. */
  double max_force;          /* [N] */
  double max_torque;         /* [N m]; ignored unless force_axes is 6. */
  double damping;            /* Physical damping, its minimum over the workspace [N s/m]. */
  double rotational_damping; /* The same for rotation [N m s/rad]. */
  double mass;               /* Moving mass as felt at the handle [kg]. */
  double inertia;            /* Moving inertia as felt at the handle [kg m^2]. */
  double max_speed;          /* Above it Nearfit stops the device [m/s]; 0, or more than 3, counts as 3. */
} NearfitDeviceDescription;

/* Bits of NearfitDevicePose.flags. */
enum {
  NEARFIT_DEVICE_CALIBRATED = 1,    /* The pose is known. The device cannot be armed before. */
  NEARFIT_DEVICE_DEAD_MAN_HELD = 2, /* The hand holds the dead-man switch. */
  NEARFIT_DEVICE_FAULT = 4          /* A fault of its own: Nearfit stops it until the user resets it. */
};

/* Pose of the handle, in the device's frame. Nearfit stops the device if a number is not finite, or if the
 * rotation's length differs from 1 by more than 0.01. */
typedef struct NearfitDevicePose {
  double position[3]; /* [m] */
  double rotation[4]; /* Unit quaternion w, x, y, z: from the handle's axes to the device's. */
  double velocity[3]; /* [m/s] */
  double age;         /* Since the measurement [s]. Forces fade from 5 ms on; at 20 ms it is stopped. */
  uint32_t buttons;   /* One bit per pressed button. Bit 0 is the clutch: while held, the part stays. */
  uint32_t flags;     /* NEARFIT_DEVICE_... bits. */
} NearfitDevicePose;

/* An open device. Defined by the plug-in; Nearfit only passes the pointer. */
typedef struct NearfitDevice NearfitDevice;

/* The functions of a plug-in. None may be null.
 *
 * Threads: `read` and `write` are called on the servo thread. They allocate nothing, take no lock that
 * another thread may hold for long, and return within 0.1 ms. `read` is also called once after `open`, before
 * the servo starts. All other functions may take their time: `count` and `describe` are called on one thread;
 * `open`, `close` and `set_forces` on one that may be another. All but `open` and `close` may be called while
 * the servo runs.
 *
 * Errors: a function that takes `error` and fails writes a sentence for the user into it, at most
 * `error_size` bytes with the zero byte at its end; a longer text is cut off. */
typedef struct NearfitDevicePlugin {
  uint32_t version; /* NEARFIT_DEVICE_VERSION as compiled. */
  uint32_t size;    /* sizeof(NearfitDevicePlugin) as compiled. */
  const char* name; /* Name of the plug-in, shown to the user. */

  /* Returns the number of devices that are plugged in now; < 0 on failure. */
  int32_t (*count)(char* error, size_t error_size);
  /* Describes a device by its index, from 0 to the last count() less 1. Returns 0 on success. */
  int32_t (*describe)(int32_t index, NearfitDeviceDescription* out, char* error, size_t error_size);
  /* Opens a device by that index, with forces off until set_forces(). Returns null on failure. */
  NearfitDevice* (*open)(int32_t index, char* error, size_t error_size);
  /* Turns forces off, closes the device and frees it. */
  void (*close)(NearfitDevice* device);
  /* Turns forces on (`are_on` not 0) or off (0). Returns 0 on success. */
  int32_t (*set_forces)(NearfitDevice* device, int32_t are_on, char* error, size_t error_size);
  /* Gives the newest pose; called once per tick. Returns 0 on success; anything else means that the device is
   * lost. */
  int32_t (*read)(NearfitDevice* device, NearfitDevicePose* out);
  /* Sets the force [N] and the torque about the handle's origin [N m] to render, in the device's frame:
   * finite, within its limits, zero while it is not armed. Called once per tick, unless force_axes is 0;
   * without a call for 20 ms the device must stop pushing. Returns 0 on success; anything else means that it
   * is lost. */
  int32_t (*write)(NearfitDevice* device, const double force[3], const double torque[3]);
} NearfitDevicePlugin;

/* The one symbol that a plug-in exports. What it returns must stay valid while the library is loaded. */
const NearfitDevicePlugin* nearfit_device_plugin(void);

#ifdef __cplusplus
}
#endif

#endif
