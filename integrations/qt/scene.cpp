#include "scene.h"

#include <cmath>

namespace gpgp::sample {

Scene::Scene(GpgpContext context, const Options& options)
    : drawing_(loadDrawing(context, options.svg)), drawingInfo_(take(drawing_.info(), "gpgpGetDrawingInfo")),
      shapes_(take(List::create(context), "gpgpCreateList")), line_({}, context, options, 32) {}

void Scene::fill(float time, float width, float height, std::vector<GpgpCanvasItem>& items) {
  const float* page = drawingInfo_.viewport;
  const float fit = std::min(width / page[2], height / page[3]);
  GpgpCanvasItem drawing = GPGP_CANVAS_ITEM_INIT;
  drawing.drawing = drawing_;
  drawing.transform[0] = drawing.transform[3] = fit;
  drawing.transform[4] = (width - page[2] * fit) / 2 - page[0] * fit;
  drawing.transform[5] = (height - page[3] * fit) / 2 - page[1] * fit;
  items.push_back(drawing);

  // A card that turns about the middle, in hundredths of the height.
  need(shapes_.clear(), "gpgpResetList");
  GpgpListShape card{};
  card.kind = GPGP_LIST_RECTANGLE;
  const float box[4] = {-24, -15, 24, 15}, radii[4] = {4, 4, 4, 4}, color[4] = {0.9f, 0.25f, 0.05f, 0.75f};
  std::copy_n(box, 4, card.box);
  std::copy_n(radii, 4, card.radii);
  std::copy_n(color, 4, card.color);
  need(shapes_.add(card), "gpgpAddShapes");
  card.width = 1.5f;
  std::fill_n(card.color, 4, 1.0f);
  need(shapes_.add(card), "gpgpAddShapes");
  GpgpListShape bar = card;
  bar.width = 0;
  const float barBox[4] = {-20, 6, -20 + 40 * time, 10};
  std::copy_n(barBox, 4, bar.box);
  std::fill_n(bar.radii, 4, 2.0f);
  if (time > 0) need(shapes_.add(bar), "gpgpAddShapes");
  const float angle = 6.2831853f * time, unit = height / 100;
  GpgpCanvasItem turned = GPGP_CANVAS_ITEM_INIT;
  turned.list = shapes_;
  turned.transform[0] = turned.transform[3] = unit * std::cos(angle);
  turned.transform[1] = unit * std::sin(angle);
  turned.transform[2] = -turned.transform[1];
  turned.transform[4] = width / 2;
  turned.transform[5] = height / 2;
  items.push_back(turned);

  GpgpCanvasItem text = GPGP_CANVAS_ITEM_INIT;
  const float scale = height / 400; // the line was laid out for 400 pixels
  text.list = line_.at(-line_.info.width / 2, -line_.info.height);
  text.transform[0] = text.transform[3] = scale;
  text.transform[4] = width / 2;
  text.transform[5] = height * 0.97f;
  if (text.list) items.push_back(text);
}

} // namespace gpgp::sample
