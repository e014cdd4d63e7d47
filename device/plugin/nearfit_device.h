/* Plug-in interface of Nearfit for haptic devices, version 3.
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

#define NEARFIT_DEVICE_VERSION 3u

/* Result of count() if the maker's driver is not installed or does not run; `error` then says what to install. */
#define NEARFIT_DEVICE_NO_DRIVER (-2)

/* A device that is plugged in. All numbers are finite and >= 0, and `rate` is 0 or from 100 to 20000; texts are UTF-8 and
 * end in a zero byte. */
typedef struct NearfitDeviceDescription {
  char name[128];            /* Shown to the user; may end with its driver's version. */
  char serial[64];           /* Serial number; empty if it has none. */
  int32_t sensed_axes;       /* Axes that it senses: 3 (place) or 6 (place and orientation). */
  int32_t force_axes;        /* Axes that it can push along: 0 (no force), 3 or 6 (force and torque). */
  int32_t has_dead_man;      /* Not 0: Nearfit sends forces only while the dead-man switch is held. */
  double rate;               /* Poses a second, at which wait() returns [Hz]; 0: Nearfit sets the pace. */
  double max_force;          /* [N] */
  double max_torque;         /* [N m]; ignored unless force_axes is 6. */
  double damping;            /* Physical damping, its minimum over the workspace [N s/m]. */
  double rotational_damping; /* The same for rotation [N m s/rad]. */
  double mass;               /* Moving mass as felt at the handle [kg]. */
  double inertia;            /* Moving inertia as felt at the handle [kg m^2]. */
  double max_speed;          /* Above it Nearfit stops the device [m/s]; 0, or more than 3, counts as 3. */
} NearfitDeviceDescription;

/* Bits of NearfitDevicePose.flags. An armed device whose pose is no longer known is stopped. */
enum {
  NEARFIT_DEVICE_CALIBRATED = 1,    /* The pose is known. The device cannot be armed before. */
  NEARFIT_DEVICE_DEAD_MAN_HELD = 2, /* The hand holds the dead-man switch. */
  NEARFIT_DEVICE_HAS_GRIP = 4       /* `grip` is measured. */
};

/* Values of NearfitDevicePose.fault. With any but NONE, Nearfit stops the device until the user resets it. */
enum {
  NEARFIT_FAULT_NONE = 0,
  NEARFIT_FAULT_OTHER = 1,       /* Any other; note() says which. */
  NEARFIT_FAULT_HOT = 2,         /* Its motors are too warm. */
  NEARFIT_FAULT_OVERLOAD = 3,    /* More force was asked for than it can give. */
  NEARFIT_FAULT_SPEED = 4,       /* Its handle moved too fast. */
  NEARFIT_FAULT_LINK = 5,        /* Its connection is disturbed. */
  NEARFIT_FAULT_SWITCHED_OFF = 6 /* Its forces were turned off at the device, or it has no power. */
};

/* Pose of the handle, in the device's frame. Nearfit stops the device if a number is not finite, or if the
 * rotation's length differs from 1 by more than 0.01. With its age forces fade from 5 ms, or two periods of `rate` if
 * that is longer, on; at 20 ms, or four periods of `rate`, it is stopped. */
typedef struct NearfitDevicePose {
  double position[3]; /* [m] */
  double rotation[4]; /* Unit quaternion w, x, y, z: from the handle's axes to the device's. */
  double velocity[3]; /* [m/s] */
  double age;         /* Since the measurement [s]. */
  uint32_t buttons;   /* One bit per pressed button. Bit 0 is the clutch: while held, the part stays. */
  uint32_t flags;     /* NEARFIT_DEVICE_... bits. */
  uint32_t fault;     /* NEARFIT_FAULT_... */
  /* Opening angle of its gripper, 0 if closed [rad]; ignored without NEARFIT_DEVICE_HAS_GRIP. Shown and recorded only. */
  double grip;
} NearfitDevicePose;

/* An open device. Defined by the plug-in; Nearfit only passes the pointer. */
typedef struct NearfitDevice NearfitDevice;

/* The functions of a plug-in. Only `wait`, `calibrate`, `reset` and `note` may be null.
 *
 * Threads: `wait`, `read` and `write` are called on the servo thread. They allocate nothing and take no lock that
 * another thread may hold for long; `read` and `write` return within 0.1 ms. `read` is also called once after `open`,
 * before the servo starts. All other functions may take their time: `count` and `describe` are called on one thread;
 * `open`, `close`, `details`, `set_forces`, `calibrate` and `reset` on one that may be another; `note` on any. All but
 * `open` and `close` may be called while the servo runs.
 *
 * Errors: a function that takes `error` and fails writes a sentence for the user into it, at most
 * `error_size` bytes with the zero byte at its end; a longer text is cut off. */
typedef struct NearfitDevicePlugin {
  uint32_t version; /* NEARFIT_DEVICE_VERSION as compiled. */
  uint32_t size;    /* sizeof(NearfitDevicePlugin) as compiled. */
  const char* name; /* Name of the plug-in, shown to the user. */

  /* Returns the number of devices that are plugged in now; < 0 on failure. */
  int32_t (*count)(char* error, size_t error_size);
  /* Describes a device by its index, from 0 to the last count() less 1, as well as it is known before it is open.
   * Returns 0 on success. */
  int32_t (*describe)(int32_t index, NearfitDeviceDescription* out, char* error, size_t error_size);
  /* Opens a device by that index, with forces off until set_forces(). Returns null on failure. */
  NearfitDevice* (*open)(int32_t index, char* error, size_t error_size);
  /* Turns forces off, closes the device and frees it. */
  void (*close)(NearfitDevice* device);
  /* Describes an open device, with its limits as read from it. Returns 0 on success. */
  int32_t (*details)(NearfitDevice* device, NearfitDeviceDescription* out);
  /* Turns forces on (`are_on` not 0) or off (0). Returns 0 on success. */
  int32_t (*set_forces)(NearfitDevice* device, int32_t are_on, char* error, size_t error_size);
  /* The user says that the handle is in its rest, or free to be moved by the device: finds its pose. May take
   * seconds. Returns 0 on success. Null if there is nothing to do. */
  int32_t (*calibrate)(NearfitDevice* device, char* error, size_t error_size);
  /* Clears a fault, which comes again if its cause persists; called only after one. Returns 0 on success. Null if there
   * is nothing to do. */
  int32_t (*reset)(NearfitDevice* device, char* error, size_t error_size);
  /* Says why the device is stopped, or what it waits for, as a sentence without a full stop; empty if there is nothing
   * to say. Null if it never says anything. */
  void (*note)(NearfitDevice* device, char* text, size_t text_size);
  /* Sleeps until a pose newer than the last one read arrives, and returns 1; or until `deadline`, a time on
   * CLOCK_MONOTONIC [ns], and returns 0. Null unless `rate` is > 0. */
  int32_t (*wait)(NearfitDevice* device, int64_t deadline);
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
