// What Flamenco Manager gives a job type script (internal/manager/job_compilers: js_globals.go, js_path.go, author.go),
// written anew for a plain JavaScript engine, with paths of one system ("/").

const printed = [];

function print(...values) {
    printed.push(values.join(" "));
}

function formatTimestampLocal(moment) {
    return moment;
}

class Task {
    constructor(name, type) {
        if (!name.trim() || !type.trim()) {
            throw "author.Task(name, type): name and type are required";
        }
        Object.assign(this, { name: name.trim(), type: type.trim(), commands: [], dependencies: [] });
    }
    addCommand(command) {
        this.commands.push(command);
    }
    addDependency(task) {
        if (!(task instanceof Task)) {
            throw "a dependency is no task";
        }
        this.dependencies.push(task.name);
    }
}

const author = {
    Task: (name, type) => new Task(name, type),
    Command: (name, parameters) => ({ name, parameters }),
};

const path = {
    join: (...parts) => parts.filter((part) => part !== "").join("/").replace(/\/+/g, "/"),
    basename: (name) => name.split("/").pop(),
    dirname: (name) => name.split("/").slice(0, -1).join("/"),
    stem: (name) => name.split("/").pop().replace(/\.[^.]*$/, ""),
};

function frameChunker(frames, size) {
    const all = new Set();
    for (const part of frames.trim().replaceAll("..", "-").split(",")) {
        const ends = part.split("-").map((end) => end.trim());
        if (ends.length > 2 || !ends.every((end) => /^[+]?\d+$/.test(end))) {
            throw `invalid range "${frames}": ${part}`;
        }
        for (let frame = Number(ends[0]); frame <= Number(ends[ends.length - 1]); frame++) {
            all.add(frame);
        }
    }
    if (size < 1 || all.size === 0) {
        throw size < 1 ? `invalid chunk size: ${size}` : `invalid range "${frames}": empty range`;
    }
    const sorted = [...all].sort((a, b) => a - b);
    const chunks = [];
    for (let at = 0; at < sorted.length; at += size) {
        chunks.push(mergeFrames(sorted.slice(at, at + size)));
    }
    return chunks;
}

function mergeFrames(frames) {
    const ranges = [];
    for (const frame of frames) {
        const last = ranges[ranges.length - 1];
        if (last && last[1] + 1 === frame) {
            last[1] = frame;
        } else {
            ranges.push([frame, frame]);
        }
    }
    const written = ([a, b]) => (a === b ? `${a}` : b === a + 1 ? `${a},${b}` : `${a}-${b}`);
    return ranges.map(written).join(",");
}

function compiled(settings) {
    const tasks = [];
    compileJob({ name: "Run", created: "2026-01-02_030405", settings, addTask: (task) => tasks.push(task) });
    return { settings, tasks };
}
