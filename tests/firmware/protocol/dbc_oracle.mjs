// Reads hoof.dbc with a parser that is not ours (npm "candied") and decodes frames that our codec
// packed: names, units and values must agree, values within half a code.
//
// usage: node dbc_oracle.mjs FOLDER_WITH_CANDIED FRAMES.json
import {createRequire} from 'node:module';
import {readFileSync} from 'node:fs';
import {join, resolve} from 'node:path';

const [folder, framesFile] = process.argv.slice(2);
const {Dbc, Can} = createRequire(join(resolve(folder), 'package.json'))('candied');
const expected = JSON.parse(readFileSync(framesFile, 'utf8'));

const complaints = [];
function demand(equal, what) {
  if (!equal) complaints.push(what);
}

// candied ends a comment at a semicolon and puts it behind; a DBC string may hold one.
const withoutSemicolons = (text) => (text ?? '').replaceAll(';', '');

function checkSignal(where, read, told) {
  demand(read.unit === told.unit, `${where}: unit "${read.unit}", not "${told.unit}"`);
  demand(read.endian === 'Motorola' && !read.signed, `${where}: not unsigned Motorola`);
  for (const [end, value] of [['min', told.minimum], ['max', told.maximum]]) {
    const near = Math.abs(read[end] - value) <= 1e-2 * told.half_code + 1e-6 * Math.abs(value);
    demand(near, `${where}: ${end} ${read[end]}, not ${value}`);
  }
  demand(withoutSemicolons(read.description) === withoutSemicolons(told.comment),
         `${where}: comment "${read.description}"`);
  for (const [code, name] of Object.entries(told.value_names)) {
    const got = read.valueTable?.get(Number(code));
    demand(got === name, `${where}: value ${code} is "${got}", not "${name}"`);
  }
}

function checkMessage(read, told) {
  if (!read) return demand(false, `${told.name}: not found`);
  demand(read.id === told.id && read.dlc === told.length, `${told.name}: identifier or length`);
  demand(read.sendingNode === told.sender, `${told.name}: sender ${read.sendingNode}`);
  demand(withoutSemicolons(read.description) === withoutSemicolons(told.comment),
         `${told.name}: comment "${read.description}"`);
  demand(read.signals.size === told.signals.length,
         `${told.name}: ${read.signals.size} signals, not ${told.signals.length}`);
  for (const signal of told.signals) {
    const where = `${told.name}.${signal.name}`;
    const found = read.signals.get(signal.name);
    if (found) checkSignal(where, found, signal);
    else demand(false, `${where}: not found`);
  }
}

/// candied's parser hands out the start bit as the file has it: for a Motorola signal the place of
/// its most significant bit. Its decoder takes that for the least significant one.
function withLastBit(signal) {
  const sawtooth = (bit) => 8 * Math.floor(bit / 8) + 7 - bit % 8;
  return {...signal, startBit: sawtooth(sawtooth(signal.startBit) + signal.length - 1)};
}

/// A value beside a code's middle is packed to the next code: half a code off at most. One
/// hundredth of it is for the rounding of float, one part in 2^22 for that of large values.
function checkFrame(can, frame, told) {
  const message = can.getMessageById(frame.id);
  if (!message) return demand(false, `frame of ${told.name} is not known`);
  for (const signal of told.signals) {
    const read = message.signals.get(signal.name);
    if (!read) continue;  // told by checkMessage
    const value = can.decodeSignal(frame.bytes, withLastBit(read)).value;
    const packed = frame.values[signal.name];
    const whole = signal.half_code === 0.5 && Number.isInteger(packed);
    const most = whole ? 0 : 1.01 * signal.half_code + Math.abs(packed) / 2 ** 22;
    demand(Math.abs(value - packed) <= most,
           `${told.name}.${signal.name}: ${value}, packed ${packed}, bytes ${frame.bytes}`);
  }
}

const database = await new Dbc().load(expected.dbc, true);
demand(database.messages.size === expected.messages.length, 'number of messages');
const can = new Can();
can.database = database;
const byId = new Map();
for (const told of expected.messages) {
  byId.set(told.id, told);
  checkMessage(database.messages.get(told.name), told);
}
const seen = new Set();
for (const frame of expected.frames) {
  seen.add(frame.id);
  checkFrame(can, frame, byId.get(frame.id));
}
demand(seen.size === expected.messages.length, 'a frame of every message');

console.log(`seed ${expected.seed}: ${expected.frames.length} frames of ${seen.size} messages`);
for (const complaint of complaints.slice(0, 20)) console.error(complaint);
if (complaints.length > 0) {
  console.error(`${complaints.length} complaints`);
  process.exit(1);
}
