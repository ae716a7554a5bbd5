// --- zip.js: several files as one, not compressed.

const CRC = Uint32Array.from({ length: 256 }, (_, n) => {
  for (let bit = 0; bit < 8; ++bit) n = n & 1 ? 0xedb88320 ^ (n >>> 1) : n >>> 1;
  return n >>> 0;
});
function crcOf(bytes) {
  let crc = 0xffffffff;
  for (const byte of bytes) crc = CRC[(crc ^ byte) & 255] ^ (crc >>> 8);
  return (crc ^ 0xffffffff) >>> 0;
}

/** Parts for a Blob. Each file: {name, data}. */
function zipOf(files) {
  const parts = [], directory = [];
  let offset = 0;
  const header = (signature, fields) => {
    const bytes = new DataView(new ArrayBuffer(4 + fields.reduce((sum, [size]) => sum + size, 0)));
    bytes.setUint32(0, signature, true);
    let at = 4;
    for (const [size, value] of fields) {
      if (size === 2) bytes.setUint16(at, value, true);
      else bytes.setUint32(at, value, true);
      at += size;
    }
    return new Uint8Array(bytes.buffer);
  };
  for (const { name, data } of files) {
    const text = new TextEncoder().encode(name), UTF8 = 0x0800, NO_TIME = 0, FIRST_DAY = 0x21;
    const common = [[2, UTF8], [2, 0], [2, NO_TIME], [2, FIRST_DAY], [4, crcOf(data)], [4, data.length], [4, data.length], [2, text.length], [2, 0]];
    parts.push(header(0x04034b50, [[2, 20], ...common]), text, data);
    directory.push(header(0x02014b50, [[2, 20], [2, 20], ...common, [2, 0], [2, 0], [2, 0], [4, 0], [4, offset]]), text);
    offset += 30 + text.length + data.length;
  }
  const size = directory.reduce((sum, bytes) => sum + bytes.length, 0);
  return [...parts, ...directory, header(0x06054b50, [[2, 0], [2, 0], [2, files.length], [2, files.length], [4, size], [4, offset], [2, 0]])];
}
