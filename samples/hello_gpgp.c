/* The smallest program that uses gpgp: a grammar of three lines becomes instances in a buffer on the GPU.
 *
 * C99, libvulkan, libgpgp and libgpgp_compiler; nothing else. Build: the target hello_gpgp, or
 *   cc hello_gpgp.c $(pkg-config --cflags --libs gpgp gpgp_compiler) -lvulkan
 * Most of it is what any Vulkan program has; the parts that are gpgp's begin with "gpgp". */
#include <gpgp/gpgp.h>     /* the whole C API */
#include <vulkan/vulkan.h> /* the engine's own Vulkan */

#include <math.h>   /* NAN */
#include <stdio.h>  /* printf */
#include <stdlib.h> /* exit */
#include <string.h> /* memcpy */

/* A box is cut into slices one metre high; each slice becomes a Floor. */
static const char kGrammar[] = "axiom Box Tower;\n"
                               "terminal Floor (1, 0);\n"
                               "Tower = Repeat(Y, 1, ADJUST_TO_FILL) Floor;\n";

/* Ends the program with a name where a call failed. gpgp's errors are negative, like Vulkan's. */
static void need(int32_t result, const char* what) {
  if (result >= 0) return;
  fprintf(stderr, "%s failed: %d\n", what, (int)result);
  exit(1);
}

/* gpgp prints nothing itself: what it has to say comes here. */
static void GPGP_CALL onMessage(void* user, const GpgpMessage* message) {
  (void)user; /* nothing of ours is needed */
  fprintf(stderr, "%s: %s\n", message->function, message->text);
}

/* Errors in the grammar come with their place, where they have one. */
static void GPGP_CALL onCompileMessage(void* user, const GpgpCompileMessage* message) {
  (void)user;
  if (message->line) fprintf(stderr, "%s:%u:%u: ", message->file, message->line, message->column);
  fprintf(stderr, "%s\n", message->text);
}

/* A buffer that both sides can reach, mapped for good. A real engine keeps the instances in device memory. */
static VkBuffer makeBuffer(VkPhysicalDevice gpu, VkDevice device, VkDeviceSize size, VkDeviceMemory* memory,
                           void** mapped) {
  VkBufferCreateInfo info = {.sType = VK_STRUCTURE_TYPE_BUFFER_CREATE_INFO};
  info.size = size;
  info.usage = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT; /* all that gpgp asks of these buffers */
  VkBuffer buffer;
  need(vkCreateBuffer(device, &info, NULL, &buffer), "vkCreateBuffer");
  VkMemoryRequirements needs; /* which memory types would do */
  vkGetBufferMemoryRequirements(device, buffer, &needs);
  VkPhysicalDeviceMemoryProperties types; /* and which there are */
  vkGetPhysicalDeviceMemoryProperties(gpu, &types);
  const VkMemoryPropertyFlags wanted = VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT | VK_MEMORY_PROPERTY_HOST_COHERENT_BIT;
  uint32_t type = 0; /* Vulkan promises that one fits */
  while (!(needs.memoryTypeBits >> type & 1u) || (types.memoryTypes[type].propertyFlags & wanted) != wanted) ++type;
  VkMemoryAllocateInfo allocate = {.sType = VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO};
  allocate.allocationSize = needs.size;
  allocate.memoryTypeIndex = type;
  need(vkAllocateMemory(device, &allocate, NULL, memory), "vkAllocateMemory");
  need(vkBindBufferMemory(device, buffer, *memory, 0), "vkBindBufferMemory");
  need(vkMapMemory(device, *memory, 0, VK_WHOLE_SIZE, 0, mapped), "vkMapMemory");
  return buffer;
}

int main(void) {
  /* ---- the engine's Vulkan: instance, first GPU, first queue family */
  VkApplicationInfo application = {.sType = VK_STRUCTURE_TYPE_APPLICATION_INFO};
  application.apiVersion = VK_API_VERSION_1_2; /* gpgp's baseline */
  VkInstanceCreateInfo instanceInfo = {.sType = VK_STRUCTURE_TYPE_INSTANCE_CREATE_INFO};
  instanceInfo.pApplicationInfo = &application;
  VkInstance instance;
  need(vkCreateInstance(&instanceInfo, NULL, &instance), "vkCreateInstance");
  VkPhysicalDevice gpu;
  uint32_t one = 1; /* the first one is good enough here */
  need(vkEnumeratePhysicalDevices(instance, &one, &gpu), "vkEnumeratePhysicalDevices");
  if (one == 0) need(-1, "finding a GPU"); /* no driver is installed */

  /* ---- what would gpgp like to have enabled? Nothing is required beyond Vulkan 1.2; this enables all it could use */
  GpgpRequirementsInfo query = GPGP_REQUIREMENTS_INFO_INIT;
  query.instance = instance;
  query.physicalDevice = gpu;
  query.getInstanceProcAddr = vkGetInstanceProcAddr; /* gpgp finds every Vulkan function through this one */
  GpgpRequirements requirements = GPGP_REQUIREMENTS_INIT;
  need(gpgpGetRequirements(&query, &requirements), "gpgpGetRequirements");

  const float priority = 1.0f;
  VkDeviceQueueCreateInfo queueInfo = {.sType = VK_STRUCTURE_TYPE_DEVICE_QUEUE_CREATE_INFO};
  queueInfo.queueFamilyIndex = 0; /* family 0 can compute on every driver we know; an engine looks */
  queueInfo.queueCount = 1;
  queueInfo.pQueuePriorities = &priority;
  VkDeviceCreateInfo deviceInfo = {.sType = VK_STRUCTURE_TYPE_DEVICE_CREATE_INFO};
  deviceInfo.pNext = &requirements.features; /* the whole feature chain */
  deviceInfo.queueCreateInfoCount = 1;
  deviceInfo.pQueueCreateInfos = &queueInfo;
  deviceInfo.enabledExtensionCount = requirements.extensionCount;
  deviceInfo.ppEnabledExtensionNames = requirements.extensions;
  VkDevice device;
  need(vkCreateDevice(gpu, &deviceInfo, NULL, &device), "vkCreateDevice");
  VkQueue queue;
  vkGetDeviceQueue(device, 0, 0, &queue);

  /* ---- a context: once, for all of gpgp */
  GpgpContextCreateInfo contextInfo = GPGP_CONTEXT_CREATE_INFO_INIT;
  contextInfo.label = "hello"; /* appears in messages and debuggers */
  contextInfo.instance = instance;
  contextInfo.physicalDevice = gpu;
  contextInfo.device = device;
  contextInfo.getInstanceProcAddr = vkGetInstanceProcAddr;
  contextInfo.features = requirements.optionalFeatures; /* what was enabled above: Vulkan could not tell */
  contextInfo.messageFn = onMessage;
  GpgpContext context;
  need(gpgpCreateContext(&contextInfo, &context), "gpgpCreateContext");

  /* ---- the grammar: text to bytes (libgpgp_compiler; a game does this when it is built), bytes to an asset */
  GpgpGrammarSource source = GPGP_GRAMMAR_SOURCE_INIT;
  source.name = "tower.pga";
  source.text = kGrammar;
  source.size = sizeof kGrammar - 1; /* without the final 0 */
  source.messageFn = onCompileMessage;
  GpgpBlob blob;
  need(gpgpCompileGrammar(&source, &blob), "gpgpCompileGrammar");
  GpgpGrammarCreateInfo grammarInfo = GPGP_GRAMMAR_CREATE_INFO_INIT;
  grammarInfo.data = blob.data;
  grammarInfo.size = blob.size;
  GpgpAsset grammar;
  need(gpgpCreateGrammar(context, &grammarInfo, &grammar), "gpgpCreateGrammar");
  gpgpFreeBlob(&blob); /* the asset has its own copy */

  /* ---- a recorder that derives grammars, for queues of family 0; its pipelines are made now, never in a frame */
  GpgpSpawnerCreateInfo spawnerInfo = GPGP_SPAWNER_CREATE_INFO_INIT;
  spawnerInfo.base.queueFamily = 0;
  GpgpRecorder spawner;
  need(gpgpCreateSpawner(context, &spawnerInfo, &spawner), "gpgpCreateSpawner");
  need(gpgpPrewarm(spawner, NULL), "gpgpPrewarm");

  /* ---- the engine's buffers: one start shape in, at most 64 instances and their number out */
  enum { kMaxInstances = 64 };
  VkDeviceMemory memories[3];
  void* mapped[3];
  VkBuffer axioms = makeBuffer(gpu, device, sizeof(GpgpAxiom), &memories[0], &mapped[0]);
  VkBuffer instances = makeBuffer(gpu, device, kMaxInstances * sizeof(GpgpInstance), &memories[1], &mapped[1]);
  VkBuffer count = makeBuffer(gpu, device, sizeof(uint32_t), &memories[2], &mapped[2]);
  GpgpAxiom axiom = {{0}}; /* zero is the default of every field that is not set below */
  axiom.transform[0] = axiom.transform[5] = axiom.transform[10] = 1.0f; /* no rotation */
  axiom.transform[7] = 5.0f; /* shapes have their origin in the middle: this one stands on the ground */
  axiom.size[0] = 4.0f;      /* a tower of 4 x 10 x 4 metres */
  axiom.size[1] = 10.0f;
  axiom.size[2] = 4.0f;
  axiom.seed = 1;
  axiom.start = GPGP_AXIOM_DEFAULT_START; /* the one that the grammar names: Tower */
  axiom.attribute = NAN;                  /* taken from the seed */
  memcpy(mapped[0], &axiom, sizeof axiom);

  /* ---- one frame: the engine's command buffer, into which gpgp records */
  VkCommandPoolCreateInfo poolInfo = {.sType = VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO};
  VkCommandPool pool;
  need(vkCreateCommandPool(device, &poolInfo, NULL, &pool), "vkCreateCommandPool");
  VkCommandBufferAllocateInfo commandInfo = {.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO};
  commandInfo.commandPool = pool;
  commandInfo.commandBufferCount = 1;
  VkCommandBuffer commands;
  need(vkAllocateCommandBuffers(device, &commandInfo, &commands), "vkAllocateCommandBuffers");
  VkCommandBufferBeginInfo begin = {.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO};
  begin.flags = VK_COMMAND_BUFFER_USAGE_ONE_TIME_SUBMIT_BIT; /* what gpgp records runs at most once */
  need(vkBeginCommandBuffer(commands, &begin), "vkBeginCommandBuffer");

  GpgpFrame frame = {1, 0}; /* this is frame 1, and nothing has finished before it */
  need(gpgpAdvance(context, &frame), "gpgpAdvance");
  need(gpgpRecordUpload(context, commands, &frame, 0, NULL), "gpgpRecordUpload"); /* the grammar goes to the GPU */
  const GpgpAccess none = {0, 0, VK_IMAGE_LAYOUT_UNDEFINED};                      /* nothing to wait for before */
  const GpgpAccess host = {VK_PIPELINE_STAGE_2_HOST_BIT, VK_ACCESS_2_HOST_READ_BIT, VK_IMAGE_LAYOUT_UNDEFINED};
  GpgpSpawnInfo spawn = GPGP_SPAWN_INFO_INIT;
  spawn.grammar = grammar;
  spawn.axioms = (GpgpBuffer){axioms, 0, sizeof(GpgpAxiom), none, none};
  spawn.axiomCount = 1;
  spawn.instances = (GpgpBuffer){instances, 0, kMaxInstances * sizeof(GpgpInstance), none, host}; /* read by us next */
  spawn.count = (GpgpBuffer){count, 0, sizeof(uint32_t), none, host};
  need(gpgpRecordPrepareSpawn(spawner, commands, &frame, &spawn), "gpgpRecordPrepareSpawn");
  need(vkEndCommandBuffer(commands), "vkEndCommandBuffer");

  /* ---- submitting and waiting are the engine's; gpgp never does */
  VkSubmitInfo submit = {.sType = VK_STRUCTURE_TYPE_SUBMIT_INFO};
  submit.commandBufferCount = 1;
  submit.pCommandBuffers = &commands;
  need(vkQueueSubmit(queue, 1, &submit, VK_NULL_HANDLE), "vkQueueSubmit");
  need(vkQueueWaitIdle(queue), "vkQueueWaitIdle");

  /* ---- the result: ten floors, each with a transform that a renderer can use as it is */
  uint32_t floors = 0;
  memcpy(&floors, mapped[2], sizeof floors);
  printf("%u instances\n", floors);
  const GpgpInstance* first = (const GpgpInstance*)mapped[1];
  for (uint32_t i = 0; i < floors; ++i)
    printf("  %.0f x %.0f x %.0f m, centre at height %.1f m\n", first[i].size[0], first[i].size[1], first[i].size[2],
           first[i].transform[7]);

  /* ---- taken down in any order that Vulkan allows; destroying the context takes its assets and recorders along */
  gpgpDestroyContext(context);
  VkBuffer buffers[3] = {axioms, instances, count};
  for (int i = 0; i < 3; ++i) {
    vkDestroyBuffer(device, buffers[i], NULL);
    vkFreeMemory(device, memories[i], NULL);
  }
  vkDestroyCommandPool(device, pool, NULL);
  vkDestroyDevice(device, NULL);
  vkDestroyInstance(instance, NULL);
  return floors == 10 ? 0 : 1; /* a test runs this program */
}
