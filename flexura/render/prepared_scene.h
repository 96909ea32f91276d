#pragma once

#include "flexura/camera/view.h"
#include "flexura/render/ray_field.h"
#include "flexura/render/stage.h"
#include "flexura/render/tiles.h"

namespace flexura {

/// A scene prepared for one view, for drawing and for queries of true values.
struct PreparedScene {
  View view;
  RayField rays;  ///< Rays of the view's pixels.
  Stage stage;    ///< The scene's bodies in the camera's frame.
  Tiles tiles;    ///< Bodies that may be visible in each image region.
};

}  // namespace flexura
