#include "core/proximity/normal_cone_tree.h"
