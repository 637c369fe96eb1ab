// Bundles the app as each bundler does when it is asked for nothing: node build.mjs NAME APP OUT; OUT/page is for browsers,
// OUT/server for node.
import { copyFileSync, mkdirSync } from "node:fs";
import { join } from "node:path";

const [, , name, app, out] = process.argv;
const at = (file) => join(app, file);
const entries = { page: at("page.js"), worker: at("worker.js"), worklet: at("worklet.js") };
const page = join(out, "page");
const server = join(out, "server");
mkdirSync(page, { recursive: true });

const bundlers = {
    async esbuild() {
        const { build } = await import("esbuild");
        const options = { bundle: true, minify: true, logLevel: "warning" };
        await build({ ...options, entryPoints: Object.values(entries), format: "esm", outdir: page });
        await build({ ...options, entryPoints: [at("server.js")], platform: "node", format: "esm", outfile: join(server, "server.mjs") });
        await build({ ...options, entryPoints: [at("server.cjs")], platform: "node", outfile: join(server, "required.cjs") });
    },
    async parcel() {
        const { Parcel } = await import("@parcel/core");
        const options = { defaultConfig: import.meta.resolve("@parcel/config-default").slice("file://".length), mode: "production",
            shouldDisableCache: true, cacheDir: join(out, "cache") };
        const targets = { distDir: page, publicUrl: "./", sourceMaps: false };
        process.chdir(app); // the project's root
        await new Parcel({ ...options, entries: ["index.html", "worklet.js"], defaultTargetOptions: targets }).run();
    },
    async rollup() {
        const { rollup } = await import("rollup");
        const { nodeResolve } = await import("@rollup/plugin-node-resolve");
        const plugins = [nodeResolve()];
        const onwarn = (warning) => { throw new Error(warning.message); };
        await (await rollup({ input: entries, plugins, onwarn })).write({ dir: page, format: "es" });
        await (await rollup({ input: at("server.js"), plugins, onwarn })).write({ dir: server, format: "es", entryFileNames: "[name].mjs",
            chunkFileNames: "[name].mjs" });
        await (await rollup({ input: at("server.js"), plugins, onwarn })).write({ dir: server, format: "cjs", entryFileNames: "[name].cjs",
            chunkFileNames: "[name].cjs" });
    },
    async vite() {
        const { build } = await import("vite");
        const options = { root: app, logLevel: "warn", configFile: false };
        const input = { index: at("index.html"), worklet: entries.worklet };
        await build({ ...options, base: "./", worker: { format: "es" }, build: { outDir: page, emptyOutDir: true,
            rollupOptions: { input, output: { entryFileNames: "[name].js" } } } });
        await build({ ...options, ssr: { noExternal: true }, build: { ssr: at("server.js"), outDir: server, emptyOutDir: true,
            rollupOptions: { output: { entryFileNames: "[name].mjs", chunkFileNames: "[name].mjs" } } } });
    },
    async webpack() {
        const { default: webpack } = await import("webpack");
        const shared = { mode: "production", context: app, performance: false };
        const run = (options) => new Promise((resolve, reject) => webpack({ ...shared, ...options }, (error, stats) => {
            if (error || stats.hasErrors() || stats.hasWarnings()) reject(error ?? new Error(stats.toString()));
            else resolve();
        }));
        await run({ entry: { page: entries.page }, output: { path: page } });
        await run({ entry: { worklet: entries.worklet }, target: "webworker", output: { path: page } });
        await run({ entry: { server: at("server.js"), required: at("server.cjs") }, target: "node", output: { path: server, filename: "[name].cjs" } });
    },
};
await bundlers[name]();
if (name !== "vite" && name !== "parcel") copyFileSync(at("index.html"), join(page, "index.html"));
