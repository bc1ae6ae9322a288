// Deflated data as it was (RFC 1951), at once: a printer does not wait for a promise.

const OF_LENGTH = 15; // the bits of an entry of a table that hold the length of its code
const CODE_ORDER = [16, 17, 18, 0, 8, 7, 9, 6, 10, 5, 11, 4, 12, 3, 13, 2, 14, 1, 15];

/** First value and number of further bits of each code of a length or of a distance. */
const ranges = (first, plain, each) => {
  const found = [];
  let value = first;
  for (let code = 0; value <= 32768; code += 1) {
    const bits = code < plain ? 0 : Math.floor((code - plain) / each) + 1;
    found.push([value, bits]);
    value += 2 ** bits;
  }
  return found;
};
const LENGTHS = ranges(3, 8, 4).slice(0, 28).concat([[258, 0]]);
const DISTANCES = ranges(1, 4, 2);

/** What stands for which symbol, by the next bits of the stream. */
const codeTable = (lengths) => {
  const longest = Math.max(1, ...lengths);
  const table = new Uint32Array(2 ** longest);
  let code = 0;
  for (let length = 1; length <= longest; length += 1) {
    for (let symbol = 0; symbol < lengths.length; symbol += 1) {
      if (lengths[symbol] !== length) continue;
      let turned = 0; // a code stands in the stream from its highest bit
      for (let bit = 0; bit < length; bit += 1) turned |= ((code >> bit) & 1) << (length - 1 - bit);
      for (let place = turned; place < table.length; place += 2 ** length) table[place] = (symbol << 4) | length;
      code += 1;
    }
    code <<= 1;
  }
  return { table, longest };
};

const FIXED = [
  codeTable([...Array(144).fill(8), ...Array(112).fill(9), ...Array(24).fill(7), ...Array(8).fill(8)]),
  codeTable(Array(30).fill(5)),
];

/** The bytes of a raw deflate stream, whose number is known. */
const inflate = (stream, size) => {
  const found = new Uint8Array(size);
  let [at, held, count, filled] = [0, 0, 0, 0];
  const hold = (bits) => {
    while (count < bits) {
      held |= (stream[at] ?? 0) << count;
      at += 1;
      count += 8;
    }
  };
  const take = (bits) => {
    hold(bits);
    const value = held & ((1 << bits) - 1);
    held >>>= bits;
    count -= bits;
    return value;
  };
  const symbolOf = ({ table, longest }) => {
    hold(longest);
    const entry = table[held & ((1 << longest) - 1)];
    held >>>= entry & OF_LENGTH;
    count -= entry & OF_LENGTH;
    return entry >> 4;
  };
  const ownCodes = () => {
    const [ofLengths, ofDistances, ofCodes] = [take(5) + 257, take(5) + 1, take(4) + 4];
    const short = Array(19).fill(0);
    for (const symbol of CODE_ORDER.slice(0, ofCodes)) short[symbol] = take(3);
    const codes = codeTable(short);
    const lengths = [];
    while (lengths.length < ofLengths + ofDistances) {
      const symbol = symbolOf(codes);
      if (symbol < 16) lengths.push(symbol);
      else if (symbol === 16) lengths.push(...Array(3 + take(2)).fill(lengths.at(-1)));
      else lengths.push(...Array(symbol === 17 ? 3 + take(3) : 11 + take(7)).fill(0));
    }
    return [codeTable(lengths.slice(0, ofLengths)), codeTable(lengths.slice(ofLengths))];
  };
  const copyStored = () => {
    at -= count >> 3; // bytes that were held, too
    [held, count] = [0, 0];
    const length = stream[at] | (stream[at + 1] << 8);
    found.set(stream.subarray(at + 4, at + 4 + length), filled);
    at += 4 + length;
    filled += length;
  };
  for (let isLast = 0; !isLast;) {
    isLast = take(1);
    const kind = take(2);
    if (kind === 0) {
      copyStored();
      continue;
    }
    const [ofLengths, ofDistances] = kind === 1 ? FIXED : ownCodes();
    for (let symbol = symbolOf(ofLengths); symbol !== 256; symbol = symbolOf(ofLengths)) {
      if (symbol < 256) {
        found[filled] = symbol;
        filled += 1;
        continue;
      }
      const [length, more] = LENGTHS[symbol - 257];
      const end = filled + length + take(more);
      const [distance, further] = DISTANCES[symbolOf(ofDistances)];
      for (const back = distance + take(further); filled < end; filled += 1) found[filled] = found[filled - back];
    }
  }
  return found;
};

/** The text of an element that holds it deflated, in base64. */
const unpack = (element) => {
  const stream = Uint8Array.from(atob(element.textContent), (letter) => letter.charCodeAt(0));
  return new TextDecoder().decode(inflate(stream, Number(element.dataset.size)));
};
