// Reads an MCAP file with a reader that is not ours (npm "@mcap/core"): by its index, with every
// CRC checked, and from front to back. Both must give all messages; raw frames, signals and times
// must be those of the JSON lines.
//
// usage: node mcap_oracle.mjs FOLDER_WITH_MCAP_CORE FILE.mcap FRAMES.jsonl
import {createRequire} from 'node:module';
import {readFileSync} from 'node:fs';
import {join, resolve} from 'node:path';

const [folder, mcapFile, framesFile] = process.argv.slice(2);
const {McapIndexedReader, McapStreamReader} =
    createRequire(join(resolve(folder), 'package.json'))('@mcap/core');
const bytes = readFileSync(mcapFile);
const told = readFileSync(framesFile, 'utf8').trim().split('\n').map((line) => JSON.parse(line));

const complaints = [];
function demand(holds, what) {
  if (!holds) complaints.push(what);
}

// The standard's polynomial, bit by bit: slow, and not ours.
function crc32(data) {
  let crc = 0xffffffff;
  for (const byte of data) {
    crc ^= byte;
    for (let bit = 0; bit < 8; ++bit) crc = (crc >>> 1) ^ (crc & 1 ? 0xedb88320 : 0);
  }
  return (crc ^ 0xffffffff) >>> 0;
}

/// The reader checks the CRCs of chunks; those of data section and summary are checked here.
function checkOuterCrcs(reader) {
  const footerStart = bytes.length - 8 - (1 + 8 + 20);
  demand(bytes[footerStart] === 0x02, 'the footer stands before the last magic bytes');
  const summaryStart = Number(reader.footer.summaryStart);
  const summary = bytes.subarray(summaryStart, bytes.length - 8 - 4);
  demand(crc32(summary) === reader.footer.summaryCrc, 'CRC of the summary');
  const dataEnd = summaryStart - (1 + 8 + 4);
  demand(bytes[dataEnd] === 0x0f, 'DataEnd stands before the summary');
  demand(crc32(bytes.subarray(0, dataEnd)) === bytes.readUInt32LE(dataEnd + 9),
         'CRC of the data section');
}

const readable = {
  size: async () => BigInt(bytes.length),
  read: async (offset, size) =>
      new Uint8Array(bytes.subarray(Number(offset), Number(offset + size))),
};
const reader = await McapIndexedReader.Initialize({readable});
checkOuterCrcs(reader);

const text = new TextDecoder();
const byTopic = new Map();
const indexed = [];
for await (const message of reader.readMessages()) {
  const channel = reader.channelsById.get(message.channelId);
  const schema = reader.schemasById.get(channel.schemaId);
  demand(channel.messageEncoding === 'json' && schema.encoding === 'jsonschema', channel.topic);
  const value = JSON.parse(text.decode(message.data));
  const properties = JSON.parse(text.decode(schema.data)).properties;
  for (const [name, field] of Object.entries(value)) {
    demand(name in properties, `${channel.topic}.${name} is not in its schema`);
    const type = properties[name]?.type;
    const fits = field === null || type === 'array' || typeof field === type ||
        (type === 'integer' && Number.isInteger(field));
    demand(fits, `${channel.topic}.${name} = ${field} is not of the type ${type}`);
  }
  if (!byTopic.has(channel.topic)) byTopic.set(channel.topic, []);
  byTopic.get(channel.topic).push({time: message.logTime, value});
  indexed.push(message);
}
const statistics = reader.statistics;
demand(Number(statistics.messageCount) === indexed.length, 'statistics count the messages');
demand(statistics.chunkCount === reader.chunkIndexes.length, 'statistics count the chunks');
demand(statistics.channelCount === reader.channelsById.size, 'statistics count the channels');
for (let i = 1; i < indexed.length; ++i) {
  demand(indexed[i].logTime >= indexed[i - 1].logTime, 'messages come in the order of time');
}

const stream = new McapStreamReader({validateCrcs: true});
stream.append(new Uint8Array(bytes));
let streamed = 0;
for (let record; (record = stream.nextRecord());) streamed += record.type === 'Message' ? 1 : 0;
demand(stream.done(), 'read to its end from front to back');
demand(streamed === indexed.length, `${streamed} messages in the stream, ${indexed.length} indexed`);

// Raw frames and decoded messages against the other export.
const place = new Map();
function next(topic) {
  const at = place.get(topic) ?? 0;
  place.set(topic, at + 1);
  return byTopic.get(topic)?.[at];
}
const first = told[0].time_s;
const firstTime = indexed.find((m) => reader.channelsById.get(m.channelId).topic === `/bus${told[0].bus}`).logTime;
function sameTime(message, frame) {
  const ns = Number(message.time - firstTime);
  return Math.abs(ns - (frame.time_s - first) * 1e9) < 500;  // told in microseconds
}
for (const frame of told) {
  const raw = next(`/bus${frame.bus}`);
  if (!raw) { demand(false, `no raw frame for ${JSON.stringify(frame)}`); break; }
  demand(raw.value.id === frame.id && sameTime(raw, frame), `raw frame at ${frame.time_s} s`);
  const hex = raw.value.data.map((b) => b.toString(16).padStart(2, '0')).join('').toUpperCase();
  demand(hex === frame.data, `data ${hex}, not ${frame.data}, at ${frame.time_s} s`);
  if (!frame.signals) continue;
  const both = byTopic.has(`/${frame.name}/bus${frame.bus}`);
  const decoded = next(both ? `/${frame.name}/bus${frame.bus}` : `/${frame.name}`);
  demand(decoded && sameTime(decoded, frame) &&
         JSON.stringify(decoded.value) === JSON.stringify(frame.signals),
         `${frame.name} at ${frame.time_s} s: ${JSON.stringify(decoded?.value)}`);
}
for (const [topic, messages] of byTopic) {
  if (topic === '/samples' || topic === '/telemetry') continue;
  demand(place.get(topic) === messages.length, `${topic}: ${messages.length} messages too many`);
}

console.log(`${indexed.length} messages on ${byTopic.size} channels in ${reader.chunkIndexes.length} chunks`);
for (const complaint of complaints.slice(0, 20)) console.error(complaint);
if (complaints.length > 0) {
  console.error(`${complaints.length} complaints`);
  process.exit(1);
}
