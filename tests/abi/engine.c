/* A small engine, in C, that hosts gpgp: own instance, device and queue, three frames, one context, one object of each
 * service that is built; a grammar is derived where there is a compiler for it. It is linked four times: beside
 * libvulkan or with its own volk and glslang, with the shared or the static gpgp. Exits 0 when every call succeeded,
 * the GPU counted what the grammar says, and gpgp sent no message.
 *
 *   ENGINE_VOLK        Vulkan through volk's global function pointers, and a glslang of its own
 *   ENGINE_SPAWN ...   the service is in the library; ENGINE_COMPILE_...: so is its compiler */
#ifdef ENGINE_VOLK
#include <volk.h>
#else
#include <vulkan/vulkan.h>
#endif

#include <gpgp/gpgp.h>

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

int engineCompilesItsShaders(void); /* engine_glslang.c */

static int failures = 0;

static void check(int ok, const char* what) {
  if (ok) return;
  fprintf(stderr, "failed: %s\n", what);
  ++failures;
}
#define VK_CHECK(call) check((call) == VK_SUCCESS, #call)
#define GPGP_CHECK(call) check((call) == GPGP_SUCCESS, #call)

static void GPGP_CALL onMessage(void* userData, const GpgpMessage* message) {
  (void)userData;
  fprintf(stderr, "%s (%s): %s\n", message->function, gpgpResultString(message->code), message->text);
  ++failures;
}

/* The device that GPGP_DEVICE names by a part of its name; without it the software device that is on every machine. */
static VkPhysicalDevice chooseDevice(VkInstance instance) {
  const char* wanted = getenv("GPGP_DEVICE");
  VkPhysicalDevice devices[16], chosen = VK_NULL_HANDLE;
  uint32_t count = 16, i;
  const VkResult listed = vkEnumeratePhysicalDevices(instance, &count, devices);
  if (listed != VK_SUCCESS && listed != VK_INCOMPLETE) return VK_NULL_HANDLE;
  for (i = 0; i < count && !chosen; ++i) {
    VkPhysicalDeviceProperties properties;
    vkGetPhysicalDeviceProperties(devices[i], &properties);
    if (strstr(properties.deviceName, wanted && *wanted ? wanted : "llvmpipe")) chosen = devices[i];
  }
  return chosen || count == 0 ? chosen : devices[0];
}

static uint32_t chooseFamily(VkPhysicalDevice device) {
  VkQueueFamilyProperties families[16];
  uint32_t count = 16, i;
  vkGetPhysicalDeviceQueueFamilyProperties(device, &count, families);
  for (i = 0; i < count; ++i)
    if ((families[i].queueFlags & VK_QUEUE_GRAPHICS_BIT) && (families[i].queueFlags & VK_QUEUE_COMPUTE_BIT)) return i;
  check(0, "a queue family with graphics and compute");
  return 0;
}

#ifdef ENGINE_SPAWN
#ifdef ENGINE_COMPILE_GRAMMAR
static GpgpAsset grammar = NULL;
#endif
static GpgpRecorder spawner = NULL;

static void useSpawn(GpgpContext context, uint32_t family) {
  GpgpSpawnerCreateInfo info = GPGP_SPAWNER_CREATE_INFO_INIT;
  info.base.label = "spawner";
  info.base.queueFamily = family;
  info.maxShapes = 1024;
  GPGP_CHECK(gpgpCreateSpawner(context, &info, &spawner));
  GPGP_CHECK(gpgpPrewarm(spawner, NULL));
#ifdef ENGINE_COMPILE_GRAMMAR
  {
    static const char text[] =
        "axiom Box A;\nterminal T (1,0);\nA = SubDiv(X) { -1: T | -1: T | -1: T | -1: T | -1: T };\n";
    GpgpGrammarSource source = GPGP_GRAMMAR_SOURCE_INIT;
    GpgpGrammarCreateInfo grammarInfo = GPGP_GRAMMAR_CREATE_INFO_INIT;
    GpgpBlob blob = {NULL, 0};
    source.name = "engine.pga";
    source.text = text;
    source.size = sizeof text - 1;
    GPGP_CHECK(gpgpCompileGrammar(&source, &blob));
    grammarInfo.label = "grammar";
    grammarInfo.data = blob.data;
    grammarInfo.size = blob.size;
    GPGP_CHECK(gpgpCreateGrammar(context, &grammarInfo, &grammar));
    gpgpFreeBlob(&blob);
    check(blob.data == NULL, "gpgpFreeBlob zeroes the blob");
  }
#endif
}

#ifdef ENGINE_COMPILE_GRAMMAR
/* Records the derivation of two axioms, five terminals each, into the first half of the buffer that `range` describes.
 */
static void recordSpawn(VkCommandBuffer commandBuffer, const GpgpFrame* frame, GpgpBuffer range, void* mapped) {
  GpgpAxiom* axioms = (GpgpAxiom*)mapped;
  GpgpSpawnInfo info = GPGP_SPAWN_INFO_INIT;
  memset(axioms, 0, 2 * sizeof *axioms);
  axioms[0].transform[0] = axioms[0].transform[5] = axioms[0].transform[10] = 1;
  axioms[0].size[0] = axioms[0].size[1] = axioms[0].size[2] = 5;
  axioms[0].start = GPGP_AXIOM_DEFAULT_START;
  axioms[1] = axioms[0];
  axioms[1].seed = 1;
  info.base.tag = 7;
  info.grammar = grammar;
  info.axiomCount = 2;
  info.axioms = info.instances = range;
  info.axioms.size = range.size / 2;
  info.instances.offset = info.instances.size = range.size / 2;
  info.instances.after.stages = VK_PIPELINE_STAGE_2_HOST_BIT;
  info.instances.after.access = VK_ACCESS_2_HOST_READ_BIT;
  GPGP_CHECK(gpgpRecordPrepareSpawn(spawner, commandBuffer, frame, &info));
}

static void checkSpawn(const void* mapped, VkDeviceSize offset) {
  const GpgpInstance* instances = (const GpgpInstance*)((const char*)mapped + offset);
  GpgpSpawnReport report = GPGP_SPAWN_REPORT_INIT;
  int i;
  GPGP_CHECK(gpgpGetSpawnReport(spawner, &report));
  check(report.base.status == GPGP_SUCCESS && report.base.tag == 7, "the record ran");
  check(report.terminals == 10 && report.instancesWritten == 10, "two axioms of five terminals");
  for (i = 0; i < 10; ++i) check(instances[i].size[0] == 1 && instances[i].size[1] == 5, "slices of one metre");
  check(gpgpGetSpawnReport(spawner, &report) == GPGP_NOT_READY, "one report a record");
}
#endif
#endif

#ifdef ENGINE_VECTOR
static void useVector(GpgpContext context, uint32_t family) {
  static const GpgpPathVerb verbs[] = {GPGP_PATH_MOVE, GPGP_PATH_LINE, GPGP_PATH_LINE, GPGP_PATH_CLOSE};
  static const float points[] = {0, 0, 10, 0, 0, 10};
  GpgpPath path;
  GpgpDrawingCreateInfo drawingInfo = GPGP_DRAWING_CREATE_INFO_INIT;
  GpgpCanvasCreateInfo info = GPGP_CANVAS_CREATE_INFO_INIT;
  GpgpAsset drawing = NULL;
  GpgpRecorder canvas = NULL;
  memset(&path, 0, sizeof path);
  path.verbs = verbs;
  path.verbCount = 4;
  path.points = points;
  path.pointCount = 3;
  path.color[3] = 1;
  drawingInfo.label = "triangle";
  drawingInfo.paths = &path;
  drawingInfo.pathCount = 1;
  GPGP_CHECK(gpgpCreateDrawing(context, &drawingInfo, &drawing));
  info.base.label = "canvas";
  info.base.queueFamily = family;
  info.maxWidth = info.maxHeight = 64;
  info.maxPaths = info.maxTileEntries = 1024;
  GPGP_CHECK(gpgpCreateCanvas(context, &info, &canvas));
  GPGP_CHECK(gpgpPrewarm(canvas, NULL));
#ifdef ENGINE_COMPILE_SVG
  {
    static const char text[] = "<svg xmlns='http://www.w3.org/2000/svg' width='8' height='8'>"
                               "<path d='M0 0h8v8z'/></svg>";
    GpgpSvgSource source = GPGP_SVG_SOURCE_INIT;
    GpgpBlob blob = {NULL, 0};
    source.name = "engine.svg";
    source.data = text;
    source.size = sizeof text - 1;
    GPGP_CHECK(gpgpCompileSvg(&source, &blob));
    gpgpFreeBlob(&blob);
  }
#endif
  gpgpDestroyRecorder(canvas);
  gpgpDestroyAsset(drawing);
}
#endif

#ifdef ENGINE_VISIBILITY
static void useVisibility(GpgpContext context, uint32_t family) {
  const GpgpMesh mesh = {0, 3, 0};
  GpgpGeometrySetCreateInfo setInfo = GPGP_GEOMETRY_SET_CREATE_INFO_INIT;
  GpgpVisibilityRecorderCreateInfo info = GPGP_VISIBILITY_RECORDER_CREATE_INFO_INIT;
  GpgpAsset set = NULL;
  GpgpRecorder recorder = NULL;
  setInfo.label = "geometry";
  setInfo.meshes = &mesh;
  setInfo.meshCount = 1;
  GPGP_CHECK(gpgpCreateGeometrySet(context, &setInfo, &set));
  info.base.label = "recorder";
  info.base.queueFamily = family;
  info.maxWidth = info.maxHeight = 64;
  info.maxDraws = 16;
  info.maxTriangles = 1024;
  GPGP_CHECK(gpgpCreateVisibilityRecorder(context, &info, &recorder));
  GPGP_CHECK(gpgpPrewarm(recorder, NULL));
  gpgpDestroyRecorder(recorder);
  gpgpDestroyAsset(set);
}
#endif

/* A buffer in memory that the host reaches, mapped for good. */
static VkBuffer makeBuffer(VkPhysicalDevice physicalDevice, VkDevice device, VkDeviceSize size, VkDeviceMemory* memory,
                           void** mapped) {
  VkBufferCreateInfo info = {VK_STRUCTURE_TYPE_BUFFER_CREATE_INFO,
                             NULL,
                             0,
                             0,
                             VK_BUFFER_USAGE_STORAGE_BUFFER_BIT,
                             VK_SHARING_MODE_EXCLUSIVE,
                             0,
                             NULL};
  VkMemoryAllocateInfo allocation = {VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO, NULL, 0, 0};
  const VkMemoryPropertyFlags wanted = VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT | VK_MEMORY_PROPERTY_HOST_COHERENT_BIT;
  VkPhysicalDeviceMemoryProperties types;
  VkMemoryRequirements needs;
  VkBuffer buffer = VK_NULL_HANDLE;
  info.size = size;
  VK_CHECK(vkCreateBuffer(device, &info, NULL, &buffer));
  vkGetBufferMemoryRequirements(device, buffer, &needs);
  vkGetPhysicalDeviceMemoryProperties(physicalDevice, &types);
  while (!(needs.memoryTypeBits >> allocation.memoryTypeIndex & 1u) ||
         (types.memoryTypes[allocation.memoryTypeIndex].propertyFlags & wanted) != wanted)
    ++allocation.memoryTypeIndex; /* Vulkan promises one */
  allocation.allocationSize = needs.size;
  VK_CHECK(vkAllocateMemory(device, &allocation, NULL, memory));
  VK_CHECK(vkBindBufferMemory(device, buffer, *memory, 0));
  VK_CHECK(vkMapMemory(device, *memory, 0, VK_WHOLE_SIZE, 0, mapped));
  return buffer;
}

static void renderFrames(VkPhysicalDevice physicalDevice, VkDevice device, uint32_t family, GpgpContext context) {
  VkCommandPoolCreateInfo poolInfo = {VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO, NULL, 0, 0};
  VkCommandBufferAllocateInfo bufferInfo = {VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO, NULL, VK_NULL_HANDLE,
                                            VK_COMMAND_BUFFER_LEVEL_PRIMARY, 1};
  const VkCommandBufferBeginInfo beginInfo = {VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO, NULL,
                                              VK_COMMAND_BUFFER_USAGE_ONE_TIME_SUBMIT_BIT, NULL};
  VkCommandPool pool = VK_NULL_HANDLE;
  VkCommandBuffer commandBuffer = VK_NULL_HANDLE;
  VkQueue queue = VK_NULL_HANDLE;
  GpgpFrame frame = {1, 0};
  VkDeviceMemory memory = VK_NULL_HANDLE;
  void* mapped = NULL;
  GpgpBuffer range;
  memset(&range, 0, sizeof range);
  range.size = 1 << 14;
  range.buffer = makeBuffer(physicalDevice, device, range.size, &memory, &mapped);
  vkGetDeviceQueue(device, family, 0, &queue);
  poolInfo.queueFamilyIndex = family;
  VK_CHECK(vkCreateCommandPool(device, &poolInfo, NULL, &pool));
  bufferInfo.commandPool = pool;
  VK_CHECK(vkAllocateCommandBuffers(device, &bufferInfo, &commandBuffer));
  for (; frame.current <= 3; ++frame.current, ++frame.safe) {
    VkSubmitInfo submit = {VK_STRUCTURE_TYPE_SUBMIT_INFO, NULL, 0, NULL, NULL, 0, NULL, 0, NULL};
    VkDeviceSize pending = 1;
    GPGP_CHECK(gpgpAdvance(context, &frame));
    VK_CHECK(vkResetCommandPool(device, pool, 0));
    VK_CHECK(vkBeginCommandBuffer(commandBuffer, &beginInfo));
    GPGP_CHECK(gpgpRecordUpload(context, commandBuffer, &frame, 0, &pending));
    check(pending == 0, "everything is uploaded");
#ifdef ENGINE_COMPILE_GRAMMAR
    if (frame.current == 2) recordSpawn(commandBuffer, &frame, range, mapped);
    if (frame.current == 3) checkSpawn(mapped, range.size / 2);
#endif
    VK_CHECK(vkEndCommandBuffer(commandBuffer));
    submit.commandBufferCount = 1;
    submit.pCommandBuffers = &commandBuffer;
    VK_CHECK(vkQueueSubmit(queue, 1, &submit, VK_NULL_HANDLE));
    VK_CHECK(vkQueueWaitIdle(queue));
  }
  vkDestroyCommandPool(device, pool, NULL);
  vkDestroyBuffer(device, range.buffer, NULL);
  vkFreeMemory(device, memory, NULL);
}

int main(void) {
  VkApplicationInfo application = {VK_STRUCTURE_TYPE_APPLICATION_INFO, NULL, "engine", 1, NULL, 0, VK_API_VERSION_1_2};
  VkInstanceCreateInfo instanceInfo = {VK_STRUCTURE_TYPE_INSTANCE_CREATE_INFO, NULL, 0, NULL, 0, NULL, 0, NULL};
  VkDeviceQueueCreateInfo queueInfo = {VK_STRUCTURE_TYPE_DEVICE_QUEUE_CREATE_INFO, NULL, 0, 0, 1, NULL};
  VkDeviceCreateInfo deviceInfo = {VK_STRUCTURE_TYPE_DEVICE_CREATE_INFO, NULL, 0, 0, NULL, 0, NULL, 0, NULL, NULL};
  GpgpRequirementsInfo requirementsInfo = GPGP_REQUIREMENTS_INFO_INIT;
  GpgpRequirements requirements = GPGP_REQUIREMENTS_INIT;
  GpgpContextCreateInfo contextInfo = GPGP_CONTEXT_CREATE_INFO_INIT;
  GpgpContext context = NULL;
  VkInstance instance = VK_NULL_HANDLE;
  VkDevice device = VK_NULL_HANDLE;
  const float priority = 1;

#ifdef ENGINE_VOLK
  VK_CHECK(volkInitialize());
  check(engineCompilesItsShaders(), "the engine's glslang, before gpgp");
#endif
  check(gpgpGetVersion() == GPGP_VERSION, "header and library have the same version");
  instanceInfo.pApplicationInfo = &application;
  VK_CHECK(vkCreateInstance(&instanceInfo, NULL, &instance));
  if (!instance) return 1;
#ifdef ENGINE_VOLK
  volkLoadInstance(instance);
#endif
  requirementsInfo.instance = instance;
  requirementsInfo.physicalDevice = chooseDevice(instance);
  requirementsInfo.getInstanceProcAddr = vkGetInstanceProcAddr;
  check(requirementsInfo.physicalDevice != VK_NULL_HANDLE, "a physical device");
  if (!requirementsInfo.physicalDevice) return 1;
  GPGP_CHECK(gpgpGetRequirements(&requirementsInfo, &requirements));

  queueInfo.queueFamilyIndex = chooseFamily(requirementsInfo.physicalDevice);
  queueInfo.pQueuePriorities = &priority;
  deviceInfo.pNext = &requirements.features;
  deviceInfo.queueCreateInfoCount = 1;
  deviceInfo.pQueueCreateInfos = &queueInfo;
  deviceInfo.enabledExtensionCount = requirements.extensionCount;
  deviceInfo.ppEnabledExtensionNames = requirements.extensions;
  VK_CHECK(vkCreateDevice(requirementsInfo.physicalDevice, &deviceInfo, NULL, &device));
  if (!device) return 1;
#ifdef ENGINE_VOLK
  volkLoadDevice(device);
#endif

  contextInfo.label = "engine";
  contextInfo.instance = instance;
  contextInfo.physicalDevice = requirementsInfo.physicalDevice;
  contextInfo.device = device;
  contextInfo.getInstanceProcAddr = vkGetInstanceProcAddr;
  contextInfo.features = requirements.optionalFeatures & ~GPGP_FEATURE_DEBUG_UTILS; /* not enabled on the instance */
  contextInfo.messageFn = onMessage;
  GPGP_CHECK(gpgpCreateContext(&contextInfo, &context));
  if (context) {
#ifdef ENGINE_SPAWN
    useSpawn(context, queueInfo.queueFamilyIndex);
#endif
#ifdef ENGINE_VECTOR
    useVector(context, queueInfo.queueFamilyIndex);
#endif
#ifdef ENGINE_VISIBILITY
    useVisibility(context, queueInfo.queueFamilyIndex);
#endif
    renderFrames(requirementsInfo.physicalDevice, device, queueInfo.queueFamilyIndex, context);
    gpgpDestroyContext(context);
  }
#ifdef ENGINE_VOLK
  check(engineCompilesItsShaders(), "the engine's glslang, after gpgp");
#endif
  vkDestroyDevice(device, NULL);
  vkDestroyInstance(instance, NULL);
  printf("%s\n", failures ? "failed" : "ok");
  return failures != 0;
}
