// SPDX-License-Identifier: GPL-3.0-or-later
//
// Flamenco job type of Ski Addon: simulate a run, bake it, render its frames in chunks, and make a video of them.
// Put this file into the folder "scripts" beside the Flamenco Manager, and restart the Manager. See docs/farm.md.

const JOB_TYPE = {
    label: "Ski Addon: Simulate, Bake, Render",
    description: "Simulate a ski run, bake it to keyframes and render it",
    settings: [
        { key: "spec", type: "string", subtype: "file_path", required: true, label: "Run Document",
          description: "Run document (.toml) on the shared storage, or the name of a preset" },
        { key: "command", type: "string", choices: ["simulate", "crowd"], default: "simulate", visible: "submission",
          label: "What It Is", description: "simulate: the document is a run; crowd: it is a crowd" },
        { key: "ground", type: "string", subtype: "file_path", required: false, default: "", label: "Heights",
          description: "File of heights that the run document names, where workers see it under another path" },
        { key: "frames", type: "string", required: true,
          eval: "f'{C.scene.frame_start}-{C.scene.frame_end}'",
          evalInfo: { showLinkButton: true, description: "Scene frame range" },
          description: "Frame range to render. Examples: '47', '1-30', '3, 5-10, 47-327'" },
        { key: "chunk_size", type: "int32", default: 10, propargs: { min: 1 }, visible: "submission",
          description: "Number of frames to render in one task" },
        { key: "output_root", type: "string", subtype: "dir_path", required: true, visible: "submission",
          description: "Folder on the shared storage; a folder named after the job is made in it" },
        { key: "output", type: "string", subtype: "dir_path", required: true, editable: false,
          eval: "str(Path(abspath(settings.output_root), jobname))",
          description: "Folder for the recording, the .blend and the frames. The same job sent again goes on there" },
        { key: "force", type: "bool", default: false, visible: "submission", label: "Large Runs",
          description: "Simulate even more than 8 GB or an hour of skiing" },
        { key: "engine", type: "string", choices: ["cycles", "workbench"], default: "cycles", visible: "submission",
          label: "Render Engine", description: "What renders; workbench is quick and plain" },
        { key: "device", type: "string", choices: ["CPU", "CUDA", "OPTIX", "HIP", "METAL", "ONEAPI"], default: "CPU",
          visible: "submission", label: "Render Device", description: "On what Cycles renders" },
        { key: "samples", type: "int32", default: 0, propargs: { min: 0 }, visible: "submission",
          description: "Samples a pixel; 0: as in the baked file" },
        { key: "size", type: "string", default: "", visible: "submission",
          eval: "f'{C.scene.render.resolution_x}x{C.scene.render.resolution_y}'",
          evalInfo: { showLinkButton: true, description: "Resolution of the scene" },
          description: "Size of the pictures in pixels, for instance 1920x1080; nothing: as in the baked file" },
        { key: "workers", type: "string", choices: ["blender", "python"], default: "blender", visible: "submission",
          label: "Workers Have",
          description: "blender: Blender with the extension Ski Addon; python: Python with ski_addon and bpy" },
        { key: "python", type: "string", default: "python", visible: "submission", label: "Python Program",
          description: "What starts Python on the workers, if they have python" },
        { key: "video", type: "bool", default: true, visible: "submission", label: "Make a Video",
          description: "Make a video of the frames, which needs FFmpeg on a worker" },

        // Automatically evaluated settings:
        { key: "fps", type: "float", eval: "C.scene.render.fps / C.scene.render.fps_base", visible: "hidden" },
    ]
};

function compileJob(job) {
    const settings = job.settings;
    fillDefaults(settings);
    checkSettings(settings);
    // So that the job shows, when it is looked at later, where its files are.
    settings.output = settings.output.replace("{timestamp}", () => formatTimestampLocal(job.created));

    const simulate = skiTask(settings, "simulate", "misc", [simulateArguments(settings)]);
    const bake = skiTask(settings, "bake", "blender", [bakeArguments(settings)]);
    bake.addDependency(simulate);
    job.addTask(simulate);
    job.addTask(bake);

    const renders = [];
    for (const chunk of frameChunker(`${settings.frames}`, settings.chunk_size)) {
        const render = skiTask(settings, `render-${chunk}`, "blender",
            spansOf(chunk).map((span) => renderArguments(settings, span)));
        render.addDependency(bake);
        job.addTask(render);
        renders.push(render);
    }
    if (settings.video) {
        const video = videoTask(settings);
        renders.forEach((render) => video.addDependency(render));
        job.addTask(video);
    }
}

// A job sent by the Manager's API may leave settings out.
function fillDefaults(settings) {
    for (const setting of JOB_TYPE.settings) {
        if (settings[setting.key] === undefined && setting.default !== undefined) {
            settings[setting.key] = setting.default;
        }
    }
}

function checkSettings(settings) {
    for (const key of ["spec", "frames", "output"]) {
        if (!`${settings[key] || ""}`.trim()) {
            throw `${key} is missing: ${descriptionOf(key)}`;
        }
    }
    if (!Number.isInteger(settings.chunk_size) || settings.chunk_size < 1) {
        throw `chunk_size = ${settings.chunk_size} is not a whole number of 1 or more`;
    }
    if (!["blender", "python"].includes(settings.workers)) {
        throw `workers = "${settings.workers}" is neither "blender" nor "python"`;
    }
    if (settings.size && !/^\d+x\d+$/.test(settings.size)) {
        throw `size = "${settings.size}" is not a size in pixels, for instance 1920x1080`;
    }
    if (settings.video && !(settings.fps > 0)) {
        throw `fps = ${settings.fps} is not a frame rate: give frames per second, or set video to false`;
    }
    checkFrames(`${settings.frames}`);
}

function descriptionOf(key) {
    return JOB_TYPE.settings.find((setting) => setting.key === key).description;
}

// The Manager would leave out a range that ends before it starts, and nobody would miss it before the film is cut.
function checkFrames(frames) {
    for (const part of frames.split(",")) {
        const match = /^\s*(\d+)\s*(?:(?:-|\.\.)\s*(\d+)\s*)?$/.exec(part);
        if (!match) {
            throw `frames = "${frames}": "${part.trim()}" is not a range of frames, for instance 1-48`;
        }
        if (match[2] !== undefined && Number(match[2]) < Number(match[1])) {
            throw `frames = "${frames}": "${part.trim()}" ends before it starts`;
        }
    }
}

// The first and last frames in a chunk: the Manager writes "4,5" for two frames, and "1-3,7" where some are left out.
function spansOf(chunk) {
    const spans = [];
    for (const part of chunk.split(",")) {
        const [first, last = first] = part.split("-").map(Number);
        const before = spans[spans.length - 1];
        if (before && before[1] + 1 === first) {
            before[1] = last;
        } else {
            spans.push([first, last]);
        }
    }
    return spans;
}

function skiTask(settings, name, taskType, commands) {
    const task = author.Task(name, taskType);
    const inBlender = settings.workers === "blender";
    for (const command of commands) {
        task.addCommand(author.Command("exec", {
            exe: inBlender ? "{blender}" : settings.python,
            args: (inBlender ? ["--command", "ski"] : ["-m", "ski_addon"]).concat(command),
        }));
    }
    return task;
}

function simulateArguments(settings) {
    const ground = settings.ground ? ["--set", `slope.grid_file=${settings.ground}`] : [];
    const force = settings.force ? ["--force"] : [];
    return [settings.command, settings.spec, "--output", path.join(settings.output, "run"), ...force, ...ground];
}

function bakeArguments(settings) {
    const ground = settings.ground ? ["--set", `slope.grid_file=${settings.ground}`] : [];
    return ["bake", path.join(settings.output, "run"), "--output", path.join(settings.output, "skier.blend"), ...ground];
}

function renderArguments(settings, [first, last]) {
    const frames = path.join(settings.output, "frames");
    return ["render", path.join(settings.output, "skier.blend"), "--output", frames, "--frames", `${first}-${last}`,
        ...renderOptions(settings)];
}

function renderOptions(settings) {
    const options = ["--engine", settings.engine];
    if (settings.engine === "cycles") {
        options.push("--device", settings.device);
    }
    if (settings.samples > 0) {
        options.push("--samples", `${settings.samples}`);
    }
    return settings.size ? options.concat("--size", settings.size) : options;
}

function videoTask(settings) {
    const task = author.Task("video", "ffmpeg");
    task.addCommand(author.Command("frames-to-video", {
        exe: "ffmpeg",
        fps: settings.fps,
        inputGlob: path.join(settings.output, "frames", "*.png"),
        outputFile: path.join(settings.output, "skier.mp4"),
        args: [
            "-c:v", "h264",
            "-crf", "20",
            "-vf", "pad=ceil(iw/2)*2:ceil(ih/2)*2", // the codec wants even numbers of pixels
            "-pix_fmt", "yuv420p",
            "-y",
        ],
    }));
    return task;
}
