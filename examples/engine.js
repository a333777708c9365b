// Six disks as on many a canvas page: 60 frames per second, overlapping disks swap what they have along the line of centres.
// node engine.js > javascript.csv
const R = 0.3, WIDTH = 4, HEIGHT = 3, DT = 1 / 60;
const disks = [
  [0.5, 0.5, 1.0, 0.7], [1.5, 0.6, -0.8, 0.4], [2.6, 0.5, 0.3, 1.1],
  [0.6, 2.2, 0.9, -0.5], [1.9, 2.1, -0.4, -0.9], [3.3, 2.3, -1.2, 0.2],
].map(([x, y, vx, vy]) => ({ x, y, vx, vy }));

function step() {
  for (const d of disks) {
    d.x += d.vx * DT;
    d.y += d.vy * DT;
    if (d.x < R || d.x > WIDTH - R) d.vx = -d.vx;
    if (d.y < R || d.y > HEIGHT - R) d.vy = -d.vy;
  }
  for (let i = 0; i < disks.length; i++) {
    for (let j = i + 1; j < disks.length; j++) {
      const a = disks[i], b = disks[j], dx = b.x - a.x, dy = b.y - a.y, distance = Math.hypot(dx, dy);
      if (distance >= 2 * R) continue;
      const nx = dx / distance, ny = dy / distance; // no look at whether they approach: the usual mistake
      const p = (a.vx - b.vx) * nx + (a.vy - b.vy) * ny;
      a.vx -= p * nx; a.vy -= p * ny;
      b.vx += p * nx; b.vy += p * ny;
    }
  }
}

const row = (time) => [time, ...disks.flatMap((d) => [d.x, d.y])].map((value) => value.toFixed(6)).join(",");
console.log(["time", ...disks.flatMap((_, i) => [`x${i}`, `y${i}`])].join(","));
for (let frame = 0; frame <= 360; frame++) {
  console.log(row(frame * DT));
  step();
}
