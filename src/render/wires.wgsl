// Wires, seen along -z of the view. Most of a wire is drawn as roofs: two quads from the sides of its outline to the line
// nearest to the eye, shaded once per pixel with the normal of the round wire. Roofs decide what hides what as round wires
// do, also where wires press a little into one another. Where a wire points to the eye it is drawn as a tube of facets; ends,
// necks and spheres are capsules: one quad, the surface found per sample.

struct View {
  rotation: mat3x3<f32>,
  centre: vec4<f32>,   // xyz [m]
  scale: vec4<f32>,    // x, y: view m -> clip; z: half depth [m]; w: size of a pixel [m]
  rim: vec4<f32>,      // rgb: light added along silhouettes; w: darkening along silhouettes
  fade: vec4<f32>,     // x: facets of a tube, z: of a roof (1: it is flat) [-],
                       // w: how steep a wire is that has no roof, y: radius over which depth darkens [m]
  signal: vec4<f32>,   // colour of broken ends, linear
  cut: vec4<f32>,      // colour of faces where a wire was cut to show what lies behind, linear
};
@group(0) @binding(0) var<uniform> view: View;

struct Segment {
  @location(0) a: vec4<f32>,   // first centre, radius [m]
  @location(1) b: vec4<f32>,   // second centre, radius [m]
  @location(2) ta: vec4<f32>,  // tangent of the wire at a; w: 0 joint, 1 round end, 2 flat, 3 neck, 4 broken face, 5 hollow, 6 disc, 7 open
  @location(3) tb: vec4<f32>,
  @location(4) ca: vec4<f32>,  // linear colour at a; w: shade of wires inside the strand, below 0 for what is see-through
  @location(5) cb: vec4<f32>,
  @location(6) oa: vec4<f32>,  // occlusion at a: sum of w d, sum of w
  @location(7) ob: vec4<f32>,
};

struct Varying {
  @builtin(position) clip: vec4<f32>,
  @location(0) p: vec2<f32>,
  @location(1) @interpolate(flat) a: vec4<f32>,
  @location(2) @interpolate(flat) b: vec4<f32>,
  @location(3) @interpolate(flat) ta: vec4<f32>,
  @location(4) @interpolate(flat) tb: vec4<f32>,
  @location(5) @interpolate(flat) ca: vec4<f32>,
  @location(6) @interpolate(flat) cb: vec4<f32>,
  @location(7) @interpolate(flat) oa: vec4<f32>,
  @location(8) @interpolate(flat) ob: vec4<f32>,
};

// How far the quad must reach beyond a centre: the full radius at an end; at a joint only what the bend opens.
fn reach(kind: f32, r: f32, tangent: vec3<f32>, along: vec3<f32>) -> f32 {
  let c = max(dot(tangent, along), 0.1);
  let bend = sqrt(max(1.0 - c * c, 0.0)) / c;
  let joint = r * min(bend + abs(along.z) + 0.05, 1.0);
  return select(joint, r, kind > 0.5);
}

@vertex fn vs(@builtin(vertex_index) vertex: u32, in: Segment) -> Varying {
  var o: Varying;
  o.a = vec4<f32>(view.rotation * (in.a.xyz - view.centre.xyz), in.a.w);
  o.b = vec4<f32>(view.rotation * (in.b.xyz - view.centre.xyz), in.b.w);
  o.ta = vec4<f32>(view.rotation * in.ta.xyz, in.ta.w);
  o.tb = vec4<f32>(view.rotation * in.tb.xyz, in.tb.w);
  o.ca = in.ca;
  o.cb = in.cb;
  o.oa = vec4<f32>(view.rotation * in.oa.xyz, in.oa.w);
  o.ob = vec4<f32>(view.rotation * in.ob.xyz, in.ob.w);

  let d = o.b.xyz - o.a.xyz;
  let length3 = length(d);
  let length2 = length(d.xy);
  let pixel = view.scale.w;
  let along = select(vec3<f32>(1.0, 0.0, 0.0), d / length3, length3 > 1e-12);
  let right = select(vec2<f32>(1.0, 0.0), d.xy / length2, length2 > 1e-12);
  let up = vec2<f32>(-right.y, right.x);
  let before = reach(in.ta.w, in.a.w, o.ta.xyz, along) + pixel;
  let after = reach(in.tb.w, in.b.w, o.tb.xyz, along) + pixel;
  let half = max(in.a.w, in.b.w) + pixel;
  let first = (vertex & 1u) == 0u;
  let side = select(-1.0, 1.0, (vertex >> 1u) == 1u);
  let end = select(o.b.xy + right * after, o.a.xy - right * before, first);
  o.p = end + up * (half * side);
  o.clip = vec4<f32>(o.p * view.scale.xy, 0.5, 1.0);
  return o;
}

// Whether an end is a plane across the axis; else it is a sphere.
fn is_flat(kind: f32) -> bool { return kind > 1.5; }

// Whether a flat end is closed by a disc; a neck goes on as its tip, and what is open lies in the wire behind it.
fn has_face(kind: f32) -> bool { return kind == 2.0 || (kind > 3.5 && kind < 6.5); }

// Whether p lies inside the outline of a segment with spheres at both ends. `along` is the axis over its squared
// length.
fn rounded_covers(p: vec2<f32>, a: vec4<f32>, b: vec4<f32>, along: vec2<f32>) -> bool {
  let w = p - a.xy;
  let s = clamp(dot(w, along), 0.0, 1.0);
  let off = w - (b.xy - a.xy) * s;
  let r = mix(a.w, b.w, s);
  return dot(off, off) <= r * r;
}

fn covers(p: vec2<f32>, in: Varying, along: vec2<f32>) -> bool {
  // The outline of a flat end has no formula as short as the ray itself; few segments have one.
  if (is_flat(in.ta.w) || is_flat(in.tb.w)) { return intersect(p, in).found; }
  return rounded_covers(p, in.a, in.b, along);
}

fn outline_axis(in: Varying) -> vec2<f32> {
  let d = in.b.xy - in.a.xy;
  return d / max(dot(d, d), 1e-18);
}

struct Hit {
  found: bool,
  z: f32,
  s: f32,             // along the axis, 0 to 1
  from_axis: vec3<f32>,
  face: f32,          // -1: the flat end at a, 1: the flat end at b, 0: elsewhere
};

// Front-most point over p: the cone between the two spheres, one of the spheres, or a flat end.
fn intersect(p: vec2<f32>, in: Varying) -> Hit {
  let a = in.a;
  let b = in.b;
  let axis = b.xyz - a.xyz;
  let l = length(axis);
  var hit: Hit;
  hit.found = false;
  hit.z = -1e30;
  hit.s = 0.0;
  hit.face = 0.0;
  let wa = p - a.xy;
  let wb = p - b.xy;
  let ha = select(a.w * a.w - dot(wa, wa), -1.0, is_flat(in.ta.w));
  let hb = select(b.w * b.w - dot(wb, wb), -1.0, is_flat(in.tb.w));
  let za = a.z + sqrt(max(ha, 0.0));
  let zb = b.z + sqrt(max(hb, 0.0));
  if (ha > 0.0 || l < 1e-12) { hit.z = za; hit.s = 0.0; hit.found = true; }
  if (hb > 0.0 && zb > hit.z) { hit.z = zb; hit.s = 1.0; hit.found = true; }
  if (l > 1e-12) {
    // |w|^2 - (w.d)^2 = (ra + k w.d)^2 with w = (p, a.z + t) - a, solved for the greater t.
    let d = axis / l;
    let k = (b.w - a.w) / l;
    let m = dot(wa, d.xy);
    let rm = a.w + k * m;
    let qa = 1.0 - d.z * d.z * (1.0 + k * k);
    let qb = -d.z * (m + k * rm);
    let qc = dot(wa, wa) - m * m - rm * rm;
    let disc = qb * qb - qa * qc;
    if (disc > 0.0 && qa > 1e-6) {
      let t = (-qb + sqrt(disc)) / qa;
      let s = (m + t * d.z) / l;
      // Where a neck joins its tip both reach over the seam, so that no sample falls between them.
      let over = 0.5 * view.scale.w / l;
      let low = select(select(0.0, -over, in.ta.w == 3.0), -over - 0.25 * a.w / l, in.ta.w == 7.0);
      let high = select(1.0, 1.0 + over, in.tb.w == 3.0);
      if (s >= low && s <= high && a.z + t > hit.z) { hit.z = a.z + t; hit.s = s; hit.found = true; }
    }
    if (abs(d.z) > 1e-4) {
      if (has_face(in.ta.w)) {
        let t = -m / d.z;
        if (dot(wa, wa) + t * t < a.w * a.w && a.z + t > hit.z) {
          hit.z = a.z + t; hit.s = 0.0; hit.face = -1.0; hit.found = true;
        }
      }
      if (has_face(in.tb.w)) {
        let t = -dot(wb, d.xy) / d.z;
        if (dot(wb, wb) + t * t < b.w * b.w && b.z + t > hit.z) {
          hit.z = b.z + t; hit.s = 1.0; hit.face = 1.0; hit.found = true;
        }
      }
    }
    // The nearest thing to a hit, for pixels whose centre just misses the outline.
    if (!hit.found) {
      hit.s = clamp(m / l, 0.0, 1.0);
      hit.z = mix(a.z, b.z, hit.s);
    }
  }
  hit.from_axis = vec3<f32>(p, hit.z) - mix(a.xyz, b.xyz, hit.s);
  return hit;
}

fn square(x: f32) -> f32 { return x * x; }

// A point of a surface, ready to be lit.
struct Point {
  z: f32,              // towards the eye [m]
  normal: vec3<f32>,
  tangent: vec3<f32>,  // of the wire
  base: vec3<f32>,     // linear colour
  shade: f32,          // of wires inside the strand, below 0 for what is see-through
  occlusion: vec4<f32>,
  flat_end: bool,
  kept: f32,           // how much of its colour it keeps in the shade
};

fn lit(point: Point, pixel: vec2<f32>) -> vec4<f32> {
  let n = point.normal;
  let o = point.occlusion;
  // Neighbours on both sides cancel in the sum of directions; what is left of the sum of weights lies to the sides.
  let sides = max(o.w - length(o.xyz), 0.0);
  let lateral = cross(point.tangent, o.xyz);
  let towards_side = dot(n, lateral) * dot(n, lateral) / max(dot(lateral, lateral), 1e-9);
  let hidden = 0.26 * o.w + 0.5 * dot(o.xyz, n) + 0.55 * sides * towards_side;
  let open = clamp(1.0 - 0.8 * hidden, 0.12, 1.0);
  // Deeper parts are a little darker, so that layers read in depth.
  let deep = clamp(0.2 + 0.8 * point.z / view.fade.y, 0.0, 1.0);
  let light = normalize(vec3<f32>(-0.35, 0.62, 0.70));
  let diffuse = max(dot(n, light), 0.0);
  let sky = 0.29 + 0.14 * n.y + 0.11 * n.z;
  // Drawn metal: a narrow streak on a broad sheen, both along the wire. Powers by squaring: 8 and 64.
  let half = max(dot(n, normalize(light + vec3<f32>(0.0, 0.0, 1.0))), 0.0);
  let sheen = square(square(square(half)));
  let streak = square(square(square(sheen)));
  let rim = 1.0 - clamp(n.z, 0.0, 1.0);
  let slant = rim * rim * rim;
  let base = point.base;
  var colour = base * (sky * open + 0.58 * diffuse * mix(0.45, 1.0, open)) * mix(0.62, 1.0, deep) * abs(point.shade);
  colour += (base * 0.10 * sheen + (0.05 + 0.28 * base) * streak) * open * select(1.0, 0.25, point.flat_end);
  let edged = select(slant, 0.0, point.flat_end);
  colour = colour * (1.0 - view.rim.w * edged) + view.rim.rgb * (0.35 + 3.0 * base) * edged * open * open;
  colour = mix(colour, max(colour, base * 0.5), point.kept);
  // One of a pixel's four samples is covered by what is see-through.
  return vec4<f32>(dithered(colour, pixel), select(1.0, 0.25, point.shade < 0.0));
}

struct Lit { colour: vec4<f32>, depth: f32, };

// Colour of a flat end, `out` radii from its middle; that of a break is a little darker than its flanks, so that the two are
// told apart.
fn face_colour(kind: f32, own: vec3<f32>, out: f32) -> vec3<f32> {
  let ring = out > 0.7;
  if (kind > 5.5) { return select(own, view.cut.rgb, ring); }
  if (kind > 4.5) { return select(vec3<f32>(0.012), view.signal.rgb, ring); }
  return select(view.cut.rgb, 0.6 * view.signal.rgb, kind > 3.5);
}

fn shade(p: vec2<f32>, in: Varying, pixel: vec2<f32>) -> Lit {
  let hit = intersect(p, in);
  let s = hit.s;
  // Normals turn steadily along the wire: what lies along the wire's own tangent is taken out, except on end caps.
  let axis = in.b.xyz - in.a.xyz;
  let l = length(axis);
  let along = axis / max(l, 1e-12);
  let behind = dot(vec3<f32>(p, hit.z) - in.a.xyz, axis) < 0.0;
  let beyond = dot(vec3<f32>(p, hit.z) - in.b.xyz, axis) > 0.0;
  let lone = l < 1e-9;
  let cap = lone || (behind && in.ta.w == 1.0) || (beyond && in.tb.w == 1.0);
  let tangent = normalize(mix(in.ta.xyz, in.tb.xyz, s) + vec3<f32>(0.0, 0.0, 1e-9));
  let radial = hit.from_axis - tangent * dot(hit.from_axis, tangent);
  // On a cone, normals lean towards the thin end.
  let lean = tangent * (in.a.w - in.b.w) * length(radial) / max(l, 1e-12);
  let face = hit.face != 0.0;
  let n = normalize(select(select(radial + lean, hit.from_axis, cap), along * hit.face, face) + vec3<f32>(0.0, 0.0, 1e-9));

  // The signal colour begins a little before the neck of a broken end.
  let band = 0.5 * mix(in.a.w, in.b.w, s);
  let soft = 0.5 * view.scale.w;
  var broken = 0.0;
  if (in.ta.w == 3.0) { broken = max(broken, 1.0 - smoothstep(band - soft, band + soft, s * l)); }
  if (in.tb.w == 3.0) { broken = max(broken, 1.0 - smoothstep(band - soft, band + soft, (1.0 - s) * l)); }
  if (in.ta.w == 4.0 || in.tb.w == 4.0) { broken = 1.0; }
  // A light collar and a dark one follow, so that eyes which see no red find the end by its brightness.
  let from_a = select(1e9, s * l, in.ta.w == 3.0);
  let from_b = select(1e9, (1.0 - s) * l, in.tb.w == 3.0);
  let from_end = min(from_a, from_b);
  let light_collar = (1.0 - broken) * (1.0 - smoothstep(1.7 * band - soft, 1.7 * band + soft, from_end));
  let dark_collar = (1.0 - broken - light_collar) * (1.0 - smoothstep(2.2 * band - soft, 2.2 * band + soft, from_end));
  var base = mix(mix(in.ca.rgb, in.cb.rgb, s), view.signal.rgb, broken);
  base = mix(mix(base, vec3<f32>(0.85), light_collar), vec3<f32>(0.01), dark_collar);
  if (face) {
    let of_a = hit.face < 0.0;
    let out = length(hit.from_axis) / max(select(in.b.w, in.a.w, of_a), 1e-12);
    base = face_colour(select(in.tb.w, in.ta.w, of_a), base, out);
  }

  var point: Point;
  point.z = hit.z;
  point.normal = n;
  point.tangent = tangent;
  point.base = base;
  point.shade = mix(in.ca.w, in.cb.w, s);
  point.occlusion = mix(in.oa, in.ob, s);
  point.flat_end = face;
  // Broken ends and cut faces keep their colour also in the shade.
  point.kept = select(max(broken, light_collar), 1.0, face);
  return Lit(lit(point, pixel), depth(hit.z));
}

fn depth(z: f32) -> f32 { return clamp(0.5 - 0.5 * z / view.scale.z, 0.0, 1.0); }

// Half a step of the 8-bit sRGB output, in a fixed pattern of pixels, hides the bands of slow gradients. The pattern
// is interleaved gradient noise (Jimenez 2014); the slope of sRGB in linear light x is about 2 sqrt(x).
fn dithered(colour: vec3<f32>, pixel: vec2<f32>) -> vec3<f32> {
  let noise = fract(52.9829189 * fract(dot(floor(pixel), vec2<f32>(0.06711056, 0.00583715)))) - 0.5;
  return colour + noise / 255.0 * 2.0 * sqrt(max(colour, vec3<f32>(0.0)));
}

struct Whole {
  @location(0) colour: vec4<f32>,
  @builtin(frag_depth) depth: f32,
};

// Smooth edges: everything at each of the four sample points. Coverage alone would leave the lines jagged where
// wires press into one another, since those are decided by depth.
@fragment fn fs_sampled(in: Varying, @builtin(sample_index) sample: u32) -> Whole {
  var offsets = array<vec2<f32>, 4>(vec2<f32>(-0.125, -0.375), vec2<f32>(0.375, -0.125),
                                    vec2<f32>(-0.375, 0.125), vec2<f32>(0.125, 0.375));
  let offset = offsets[sample] * view.scale.w;
  // Rows of the picture run down, view axes up.
  return seen(in.p + vec2<f32>(offset.x, -offset.y), in);
}

// For adapters that cannot: once per pixel.
@fragment fn fs_whole(in: Varying) -> Whole { return seen(in.p, in); }

fn seen(p: vec2<f32>, in: Varying) -> Whole {
  if (!covers(p, in, outline_axis(in))) { discard; }
  let found = shade(p, in, in.clip.xy);
  return Whole(found.colour, found.depth);
}

struct Side {
  @builtin(position) clip: vec4<f32>,
  @location(0) @interpolate(linear) normal: vec3<f32>,   // of the corners
  @location(1) @interpolate(linear) tangent: vec4<f32>,  // w: the axis's height towards the eye [m]
  @location(2) @interpolate(linear) colour: vec4<f32>,   // w: shade
  @location(3) @interpolate(linear) occlusion: vec4<f32>,
  @location(4) @interpolate(linear) radius: f32,         // [m]
};

// A direction across a wire in the plane of the picture.
fn sideways(tangent: vec3<f32>) -> vec3<f32> {
  return normalize(vec3<f32>(-tangent.y, tangent.x + 1e-9, 0.0));
}

// A corner of a roof or tube: one end of the segment or the other, `out` radii from the axis.
fn corner(in: Segment, far: bool, tangent: vec3<f32>, normal: vec3<f32>, out: f32) -> Side {
  let end = select(in.a, in.b, far);
  let occlusion = select(in.oa, in.ob, far);
  let axis = view.rotation * (end.xyz - view.centre.xyz);
  let p = axis + normal * (out * end.w);
  var o: Side;
  o.normal = normal;
  o.radius = end.w;
  o.tangent = vec4<f32>(tangent, axis.z);
  o.colour = select(in.ca, in.cb, far);
  o.occlusion = vec4<f32>(view.rotation * occlusion.xyz, occlusion.w);
  o.clip = vec4<f32>(p.xy * view.scale.xy, depth(p.z), 1.0);
  return o;
}

@vertex fn vs_roof(@builtin(vertex_index) vertex: u32, in: Segment) -> Side {
  let far = (vertex & 1u) == 1u;
  let tangent = view.rotation * select(in.ta.xyz, in.tb.xyz, far);
  let across = sideways(tangent);
  let u = 2.0 * f32(vertex >> 1u) / view.fade.z - 1.0;
  return corner(in, far, tangent, across * u + cross(tangent, across) * (1.0 - abs(u)), 1.0);
}

@vertex fn vs_tube(@builtin(vertex_index) vertex: u32, in: Segment) -> Side {
  let far = (vertex & 1u) == 1u;
  let tangent = view.rotation * select(in.ta.xyz, in.tb.xyz, far);
  let angle = 6.2831853 * f32(vertex >> 1u) / view.fade.x;
  let across = normalize(vec3<f32>(0.0, -tangent.z, tangent.y));
  let normal = across * sin(angle) + cross(tangent, across) * cos(angle);
  // Where a roof goes on, the half that is seen has its shape.
  let u = abs(dot(normal, sideways(tangent)));
  let up = dot(normal, cross(tangent, sideways(tangent)));
  let roofed = abs(tangent.z) < view.fade.w && up > 0.0;
  return corner(in, far, tangent, normal, select(1.0, 1.0 / (u + up), roofed));
}

fn side(in: Side, normal: vec3<f32>, tangent: vec3<f32>) -> vec4<f32> {
  var point: Point;
  point.z = in.tangent.w + in.radius * normal.z;
  point.normal = normal;
  point.tangent = tangent;
  point.base = in.colour.rgb;
  point.shade = in.colour.w;
  point.occlusion = in.occlusion;
  point.flat_end = false;
  point.kept = 0.0;
  return lit(point, in.clip.xy);
}

// Light of a roof as far to the side of its axis as `u` radii.
fn roof(in: Side, tangent: vec3<f32>, across: vec3<f32>, u: f32) -> vec4<f32> {
  // A pixel that is covered in part is lit as what it covers, a quarter of a pixel inside the outline.
  let edge = max(1.0 - 0.25 * view.scale.w / in.radius, 0.5);
  let v = clamp(u, -edge, edge);
  return side(in, across * v + cross(tangent, across) * sqrt(1.0 - v * v), tangent);
}

@fragment fn fs_roof(in: Side) -> @location(0) vec4<f32> {
  let tangent = normalize(in.tangent.xyz);
  let across = sideways(tangent);
  return roof(in, tangent, across, dot(in.normal, across));
}

// A wire a few pixels wide: its light changes within a pixel.
@fragment fn fs_thin_roof(in: Side) -> @location(0) vec4<f32> {
  let tangent = normalize(in.tangent.xyz);
  let across = sideways(tangent);
  let u = dot(in.normal, across);
  let step = 0.25 * view.scale.w / in.radius;
  return 0.5 * (roof(in, tangent, across, u - step) + roof(in, tangent, across, u + step));
}

@fragment fn fs_tube(in: Side) -> @location(0) vec4<f32> {
  return side(in, normalize(in.normal), normalize(in.tangent.xyz));
}
