#pragma once

#include "flexura/camera/view.h"
#include "flexura/render/ray_field.h"
#include "flexura/render/stage.h"
#include "flexura/render/tiles.h"

namespace flexura {

/// A scene as one view sees it, ready to be drawn or asked.
struct PreparedScene {
  View view;
  RayField rays;  ///< Of its pixels.
  Stage stage;    ///< The scene's bodies in the camera's frame.
  Tiles tiles;    ///< Which of these may be seen where in the picture.
};

}  // namespace flexura
