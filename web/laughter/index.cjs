"use strict";
module.exports = require("node:fs").readFileSync(require("node:path").join(__dirname, "index.js"), "utf8").split('"')[1];
