// What a page computes beside the emitted kinematics: poses, turns, singular values, and the way
// along a path.
//
// Poses are 4×4, row by row (16 numbers); J is 6×m, row by row: three rows of the angular velocity,
// then three of the velocity of the tool's origin, in the axes of the base. rad and m.
// Accuracy: that of the tests, tests/view/web/test_mathematics.py. u = 2^-53.

const LOCK = 6.6e-16; // sine or cosine of pitch up to which roll and yaw are one turn
const PARTS = { pose: [0, 6], rotation: [0, 3], translation: [3, 6] }; // rows of J

export function product(A, B) {
    const C = new Float64Array(16);
    for (let r = 0; r < 16; r += 4) {
        for (let k = 0; k < 4; k++) {
            C[r + k] = A[r] * B[k] + A[r + 1] * B[4 + k] + A[r + 2] * B[8 + k] + A[r + 3] * B[12 + k];
        }
    }
    return C;
}

export function inverse(T) {
    const [a, b, c, x, d, e, f, y, g, h, i, z] = T;
    return Float64Array.of(
        a, d, g, -(a * x + d * y + g * z),
        b, e, h, -(b * x + e * y + h * z),
        c, f, i, -(c * x + f * y + i * z),
        0, 0, 0, 1,
    );
}

export function positionOf(T) {
    return [T[3], T[7], T[11]];
}

// The pose of a unit quaternion (x, y, z, w) and a position.
export function poseOf([x, y, z, w], [px, py, pz] = [0, 0, 0]) {
    return Float64Array.of(
        w * w + x * x - y * y - z * z, 2 * (x * y - w * z), 2 * (z * x + w * y), px,
        2 * (x * y + w * z), w * w + y * y - z * z - x * x, 2 * (y * z - w * x), py,
        2 * (z * x - w * y), 2 * (y * z + w * x), w * w + z * z - x * x - y * y, pz,
        0, 0, 0, 1,
    );
}

// The unit quaternion (x, y, z, w), w >= 0, of a pose's rotation (Shepperd 1978: from the component
// of largest size, so that nothing cancels).
export function quaternionOf(T) {
    const [a, b, c, , d, e, f, , g, h, i] = T;
    const squares = [1 + a - e - i, 1 + e - i - a, 1 + i - a - e, 1 + a + e + i]; // 4 q_k^2
    const rows = [
        [squares[0], b + d, c + g, h - f],
        [b + d, squares[1], f + h, c - g],
        [c + g, f + h, squares[2], d - b],
        [h - f, c - g, d - b, squares[3]],
    ];
    const row = rows[squares.reduce((best, x, k) => (x > squares[best] ? k : best), 0)];
    const length = Math.sqrt(dot(row, row)) * (row[3] < 0 ? -1 : 1);
    return row.map((x) => x / length + 0);
}

// (roll, pitch, yaw) of R = Rz(yaw) Ry(pitch) Rx(roll). Yaw is read off the first column and taken
// out of R before the others are read, so that the lock (pitch ±π/2, where roll is 0) is no worse.
export function rollPitchYaw(T) {
    const [a, b, c, , d, e, f, , g] = T;
    const cosine = Math.hypot(a, d);
    if (cosine < LOCK) {
        return [0, Math.atan2(-g, cosine), Math.atan2(-b, e) + 0];
    }
    const s = d / cosine;
    const k = a / cosine;
    return [Math.atan2(s * c - k * f, k * e - s * b), Math.atan2(-g, cosine), Math.atan2(d, a)].map((x) => x + 0);
}

// Axis and angle φ, 0 <= φ <= π, of a pose's rotation: {axis, angle}; axis (0, 0, 0) of none.
export function axisAngle(T) {
    const [x, y, z, w] = quaternionOf(T);
    const sine = Math.hypot(x, y, z);
    const axis = sine === 0 ? [0, 0, 0] : [x / sine, y / sine, z / sine];
    return { axis, angle: 2 * Math.atan2(sine, w) };
}

// The displacement D gone k times: a turn by kφ about D's own screw axis, and k times its way along.
// Across the axis the way grows by (e^{ikφ} - 1) / (e^{iφ} - 1), which has no difference to cancel.
export function power(D, k) {
    const { axis, angle } = axisAngle(D);
    const half = angle / 2;
    const turn = Math.sin(k * half);
    const t = positionOf(D);
    const q = [...axis.map((n) => n * turn), Math.cos(k * half)];
    if (angle === 0) {
        return poseOf(q, t.map((x) => k * x));
    }
    const along = axis[0] * t[0] + axis[1] * t[1] + axis[2] * t[2];
    const grown = turn / Math.sin(half);
    const c = grown * Math.cos((k - 1) * half);
    const s = grown * Math.sin((k - 1) * half);
    const over = cross3(axis, t);
    return poseOf(q, t.map((x, r) => k * along * axis[r] + c * (x - along * axis[r]) + s * over[r]));
}

// The pose B with its displacement from A gone k times: A at k = 0, B at k = 1. It does not matter in
// which frame of the body A and B are given.
export function exaggerate(A, B, k) {
    return product(power(product(B, inverse(A)), k), A);
}

// The pose a share of the way from A to B: the origin on a line, the rotation on a geodesic.
export function between(A, B, share) {
    const R = exaggerate(withPosition(A, [0, 0, 0]), withPosition(B, [0, 0, 0]), share);
    const p = positionOf(A);
    return withPosition(R, positionOf(B).map((x, r) => p[r] + share * (x - p[r])));
}

export function withPosition(T, [x, y, z]) {
    const moved = Float64Array.from(T);
    moved[3] = x;
    moved[7] = y;
    moved[11] = z;
    return moved;
}

// (φ n; p* - p) from a pose to its target, axes of the base: e^{[n] φ} R = R*. Its half square has
// the gradient -J^T e, near the target and far from it.
export function poseError(T, target) {
    const turn = product(withPosition(target, [0, 0, 0]), inverse(withPosition(T, [0, 0, 0])));
    const { axis, angle } = axisAngle(turn);
    return [...axis.map((n) => n * angle), target[3] - T[3], target[7] - T[7], target[11] - T[11]];
}

export function cross3([a, b, c], [x, y, z]) {
    return [b * z - c * y, c * x - a * z, a * y - b * x];
}

// Singular values s, the largest first, and left singular vectors U (one list each) of rows of J.
// One-sided Jacobi (Hestenes 1958): the rows are turned in pairs until they are at right angles, so
// that small values are right to u times the largest, which those of J J^T are not.
export function singularValues(J, first, last, length = 1) {
    const m = J.length / 6;
    const count = last - first;
    const rows = [];
    const turns = [];
    for (let r = first; r < last; r++) {
        rows.push(J.slice(r * m, r * m + m).map((x) => (r < 3 ? x : x / length)));
        turns.push(Array.from({ length: count }, (_, k) => (k === r - first ? 1 : 0)));
    }
    for (let sweep = 0; sweep < 20; sweep++) {
        if (!orthogonalize(rows, turns)) {
            break;
        }
    }
    const sizes = rows.map((row) => Math.sqrt(dot(row, row)));
    const order = sizes.map((_, k) => k).sort((a, b) => sizes[b] - sizes[a]);
    return { s: order.map((k) => sizes[k]), U: order.map((k) => turns[k]) };
}

// One sweep; whether any pair was turned.
function orthogonalize(rows, turns) {
    const squares = rows.map((row) => dot(row, row));
    const least = 2 ** -108 * Math.max(...squares); // rows below the rounding of the largest
    let turned = false;
    for (let i = 0; i < rows.length; i++) {
        for (let j = i + 1; j < rows.length; j++) {
            const alpha = dot(rows[i], rows[i]);
            const beta = dot(rows[j], rows[j]);
            const gamma = dot(rows[i], rows[j]);
            const size = Math.sqrt(alpha) * Math.sqrt(beta);
            if (Math.min(alpha, beta) <= least || !(Math.abs(gamma) > 2 ** -52 * size)) {
                continue;
            }
            const zeta = (beta - alpha) / (2 * gamma);
            const t = (zeta < 0 ? -1 : 1) / (Math.abs(zeta) + Math.sqrt(1 + zeta * zeta));
            const c = 1 / Math.sqrt(1 + t * t);
            rotateRows(rows, i, j, c, c * t);
            rotateRows(turns, i, j, c, c * t);
            turned = true;
        }
    }
    return turned;
}

function rotateRows(rows, i, j, c, s) {
    for (let k = 0; k < rows[i].length; k++) {
        const x = rows[i][k];
        const y = rows[j][k];
        rows[i][k] = c * x - s * y;
        rows[j][k] = s * x + c * y;
    }
}

function dot(x, y) {
    let total = 0;
    for (let k = 0; k < x.length; k++) {
        total += x[k] * y[k];
    }
    return total;
}

// Largest rank of a part ("pose", "rotation", "translation") of some Jacobians: the number of motions
// that an arm has at all. The counts of tests, in units of the arm's own size.
export function largestRank(jacobians, part) {
    const [first, last] = PARTS[part];
    let length = 1e-300;
    for (const J of jacobians) {
        length = J.subarray(J.length / 2).reduce((x, y) => Math.max(x, Math.abs(y)), length);
    }
    const ranks = jacobians.map((J) => {
        const { s } = singularValues(J, first, last, length);
        return s.filter((x) => x > Math.max(1e-3 * s[0], 1e-9)).length;
    });
    return Math.max(0, ...ranks);
}

// The part by which an arm's singularities are judged, from some of its Jacobians: its tool's position
// where that alone takes all coordinates.
export function defaultPart(jacobians) {
    const m = jacobians[0].length / 6;
    return largestRank(jacobians, "translation") === m ? "translation" : "pose";
}

// Yoshikawa's measure, condition number and smallest singular value of a part, by its `rank` largest
// singular values, as `poekin.manipulability`; of the pose with v ÷ length.
export function manipulability(J, part, rank, length = 1) {
    const { s } = singularValues(J, ...PARTS[part], part === "pose" ? length : 1);
    const counted = s.slice(0, Math.max(Math.min(rank, J.length / 6), 1));
    const smallest = counted[counted.length - 1];
    return {
        yoshikawa: counted.reduce((x, y) => x * y, 1),
        condition: smallest > 0 ? counted[0] / smallest : Infinity,
        smallest,
    };
}

// The matrix that takes the unit sphere to the manipulability ellipsoid, J_v J_v^T = M M^T, about the
// tool's origin: M's columns are its half axes, times a factor, and `least` long where it is flat.
// Part "translation" or "rotation".
export function ellipsoid(T, J, part, factor = 1, least = 0) {
    const { s, U } = singularValues(J, ...PARTS[part]);
    const third = cross3(U[0], U[1]); // right-handed: a mirrored surface would be inside out
    const axes = [U[0], U[1], third];
    const M = new Float64Array(16);
    for (let r = 0; r < 3; r++) {
        for (let k = 0; k < 3; k++) {
            M[4 * r + k] = Math.max(factor * s[k], least) * axes[k][r];
        }
        M[4 * r + 3] = T[4 * r + 3];
    }
    M[15] = 1;
    return M;
}

// The unit twist (ω; v), |(ω; v / length)| = 1, that the arm moves worst of the `rank` motions that it
// has at all, and its singular value ÷ the largest. Its largest component is positive.
export function singularDirection(J, part, rank, length) {
    const [first, last] = PARTS[part];
    const { s, U } = singularValues(J, first, last, part === "rotation" ? 1 : length);
    const worst = Math.max(Math.min(rank, J.length / 6), 1) - 1;
    const unit = [...Array(first).fill(0), ...U[worst], ...Array(6 - last).fill(0)];
    const motion = unit.map((x, r) => (r < 3 ? x : x * length));
    const largest = motion.reduce((x, y) => (Math.abs(y) > Math.abs(x) ? y : x));
    const twist = motion.map((x) => (largest < 0 ? -x : x) + 0);
    return { twist, smallest: s[worst], ratio: s[0] > 0 ? s[worst] / s[0] : 0 };
}

// The damped step (J^T J + damping I) dq = J^T e over the coordinates that are free, by the rows of J
// from the first on; 0 for all others. damping > 0. H = L D L^T without square roots.
export function dampedStep(J, e, damping, free, first = 0) {
    const m = J.length / 6;
    const H = new Float64Array(m * m);
    const dq = new Float64Array(m);
    let largest = 0;
    for (let i = 0; i < m; i++) {
        for (let k = 0; free[i] && k <= i; k++) {
            for (let r = first; free[k] && r < 6; r++) {
                H[i * m + k] += J[r * m + i] * J[r * m + k];
            }
        }
        for (let r = first; free[i] && r < 6; r++) {
            dq[i] += J[r * m + i] * e[r];
        }
        H[i * m + i] += damping;
        largest = Math.max(largest, H[i * m + i]);
    }
    for (let i = 0; i < m; i++) {
        H[i * m + i] += 1e-14 * largest; // some ten times its rounding: J^T J may be singular
    }
    solveSymmetric(H, dq, m);
    return dq;
}

// The solution in place of g; H, positive definite, lower triangle, is lost.
function solveSymmetric(H, g, m) {
    for (let j = 0; j < m; j++) {
        for (let i = j; i < m; i++) {
            let total = H[i * m + j];
            for (let k = 0; k < j; k++) {
                total -= H[i * m + k] * H[j * m + k] * H[k * m + k];
            }
            H[i * m + j] = i > j ? total / H[j * m + j] : total;
        }
    }
    for (let i = 0; i < m; i++) {
        for (let k = 0; k < i; k++) {
            g[i] -= H[i * m + k] * g[k];
        }
    }
    for (let i = m - 1; i >= 0; i--) {
        g[i] /= H[i * m + i];
        for (let k = i + 1; k < m; k++) {
            g[i] -= H[k * m + i] * g[k];
        }
    }
}

// Limits of sliders as two arrays; null and undefined are no limit.
export function limitsOf(coordinates) {
    return {
        low: Float64Array.from(coordinates, (x) => x.lower ?? -Infinity),
        high: Float64Array.from(coordinates, (x) => x.upper ?? Infinity),
    };
}

// The range that a coordinate is drawn from: its limits, else half a turn or 1 m about 0 or beside the
// limit that it has.
export function rangeOf({ lower, upper, unit }) {
    const half = unit === "m" ? 1 : Math.PI;
    const low = Number.isFinite(lower) ? lower : null;
    const high = Number.isFinite(upper) ? upper : null;
    return [low ?? (high === null ? -half : high - 2 * half), high ?? (low === null ? half : low + 2 * half)];
}

// Configuration number k of a fixed sequence that fills the ranges evenly; number 0 is their middle.
// Steps by the powers of 1 / g, g^{m+1} = g + 1 (Roberts's sequence).
export function spread(coordinates, k) {
    let g = 2;
    for (let n = 0; n < 40; n++) {
        g = (1 + g) ** (1 / (coordinates.length + 1));
    }
    return coordinates.map((coordinate, i) => {
        const [low, high] = rangeOf(coordinate);
        const share = (0.5 + k * g ** -(i + 1)) % 1;
        return low + share * (high - low);
    });
}

// Distance of each coordinate from the nearer of its limits, infinite where it has none, negative
// beyond them; and the number of the least.
export function limitDistances(q, coordinates) {
    const { low, high } = limitsOf(coordinates);
    const distances = Array.from(q, (x, k) => Math.min(x - low[k], high[k] - x));
    return { distances, nearest: distances.indexOf(Math.min(...distances)) };
}

// Row of a path at a time: {q, row, share}, between rows `row` and `row + 1`, linear in q. Before the
// first time and after the last the path rests; of two rows at one time the later counts.
export function alongPath(times, rows, time) {
    const end = times.length - 1;
    if (!(time < times[end])) {
        return { q: Array.from(rows[end]), row: end, share: 0 };
    }
    let row = 0;
    let above = end;
    while (above - row > 1) {
        const middle = (row + above) >> 1;
        if (times[middle] <= time) {
            row = middle;
        } else {
            above = middle;
        }
    }
    const share = Math.max(0, (time - times[row]) / (times[above] - times[row]));
    return { q: Array.from(rows[row], (x, k) => x + share * (rows[above][k] - x)), row, share };
}
