// Light of one lamp that reaches a layer of cells, by cones of cuboids (Schlegel2011, Eq. 7, Fig. 7; methods.md).
//
// POINTS     0: the lamp is a disc seen from each cell (a parallel light's cone, a sphere), 1: it is given by places on it
// CONES      the lamp's cone is taken apart into so many narrow ones
// PART       0: all of the way to the lamp. Of a wide cone, where what is far is soft, 1: only what is far, for each 2^3 cells;
//            2: what is near, times what is far
#include "sums"

flat in int v_layer;
uniform sampler3D u_near;            // how open cells are; 0 where light does not matter
uniform vec3 u_edge_mm;              // a cell's edges in mm
uniform float u_cell_mm;             // their mean, to which the cells' optical depths refer
uniform vec4 u_lamp;                 // in mm from the corner of cell 0 along the volume's axes: place (w = 1), or unit vector towards it (w = 0)
uniform float u_tangent;             // of the lamp's half angle; < 0: from its radius
uniform float u_radius;              // mm (POINTS 0)
uniform vec2 u_disc[CONES];          // places of the narrow cones in the unit disc, spread over a cell as well
uniform vec3 u_place[CONES];         // places on the lamp, mm
uniform float u_part;                // radius of a narrow cone: share of the disc's (POINTS 0), or mm
uniform vec3 u_shines;               // unit vector in which an area lamp shines; zero: in all directions
uniform vec3 u_beam;                 // unit vector of a spot's beam
uniform vec2 u_beam_edge;            // cosines at which the beam is dark and full; x >= y: not a spot
uniform float u_reach;               // mm at which the light has halved; <= 0: everywhere the same
uniform float u_first;               // first section, in cells along the dominant axis
uniform float u_growth;              // relative growth of the sections
uniform float u_strength;

#if PART
uniform int u_around;                // cells from what is visible within which the share is needed
uniform int u_split;                 // layers from the middle of 2^3 cells at which far begins
#endif
#if PART == 2
uniform sampler3D u_far;             // share of the light that what is far lets through
uniform sampler3D u_matter;          // the cells themselves, before they were added up
#endif
uniform float u_unshadowed;          // 1: nothing is in the way

layout(location = 0) out vec2 o_light;       // light times openness, and openness; PART 1: the share

const int MOST = 160;                // sections of a cone
const float ACROSS_A_CELL = 0.6;     // radius in cells within which the cones start
const float DRIFT = 1.0;             // cells by which a section's way may leave its box
const float DARK = 3e-4;             // light that is as good as none

// Light on its way through a cone, from section to section: background * (1 - share + share * within).
//
// Dense matter fills a share of a section's width, light passes beside it. A thing that goes on in the next section
// takes away no more of what passes beside; one that ends and another that begins do. The mean of all that is in the
// cone (the paper's) would let a rod in a wide cone cast the shadow of a wall.
struct Passing { float background, share, within; };

float light_of(Passing p) { return p.background * (1.0 - p.share + p.share * p.within); }

// Through a section whose mean matter is known, so many cells long, in so many layers.
void pass(inout Passing p, vec4 mean, float cells, float layers) {
    // What fills one layer of several may be a wall across the way. Then it has as much surface: two sides in a long
    // section (less than half of all the surface there, as a wall may lie aslant), of which a short one may see but one;
    // or it goes on from the section before.
    float sides = mix(1.5, 0.4, clamp((layers - 2.0) / 4.0, 0.0, 1.0)) * mean.a * layers;
    float share = clamp(max(mean.b, min(mean.b * layers, max(sides, p.share))), 0.0, 1.0);
    if (share < p.share) {
        // What was dimmed and is no longer in the way is beside from now on.
        float beside = max((1.0 - p.share + (p.share - share) * p.within) / max(1.0 - share, 1e-6), 1e-6);
        p.background *= beside;
        p.within = min(p.within / beside, 1.0);
    } else {
        p.within = (p.share * p.within + share - p.share) / max(share, 1e-6);
    }
    p.share = share;
    p.within *= exp(-mean.g / max(share, 1e-6) * cells * u_strength);
    p.background *= exp(-mean.r * cells * u_strength);
}

// Vectors with the dominant axis first, and back.
vec3 turned(vec3 v, int axis) { return axis == 0 ? v : axis == 1 ? v.yzx : v.zxy; }
ivec3 turned(ivec3 v, int axis) { return axis == 0 ? v : axis == 1 ? v.yzx : v.zxy; }
vec3 turned_back(vec3 v, int axis) { return axis == 0 ? v : axis == 1 ? v.zxy : v.yzx; }
ivec3 turned_back(ivec3 v, int axis) { return axis == 0 ? v : axis == 1 ? v.zxy : v.yzx; }

int dominant(vec3 along) {
    vec3 steep = abs(along / u_edge_mm);
    return steep.x >= max(steep.y, steep.z) ? 0 : steep.y >= steep.z ? 1 : 2;
}

#if PART != 2
// Light that comes through a cone from a place, in cells, along a unit vector, as far as `end` mm: from `begin` layers along an
// axis on, where layers meet. It starts that far beside the place, in cells: boxes are whole cells, and cones that all start
// alike would round theirs alike, which leaves steps in the shadows of small lamps.
float through(vec3 place, int axis, vec3 along, float tangent, float end, vec2 beside, float begin) {
    vec3 edge = turned(u_edge_mm, axis), way = turned(along, axis), at = turned(place, axis);
    ivec3 cells = turned(u_cells, axis);
    int sign_of = way.x > 0.0 ? 1 : -1;
    float steepness = max(abs(way.x), 1e-3);
    float length_mm = edge.x / steepness;                           // of the way through one layer of cells
    vec2 slope = way.yz / steepness * edge.x / edge.yz;             // cells across for one along
    float slant = max(abs(slope.x), abs(slope.y));
    vec2 lean = sqrt(1.0 + way.yz * way.yz / (steepness * steepness));  // a section across the axis is longer than the cone is wide
    float last = end / length_mm;                                   // in layers from the place
    float from = begin, width = u_first + u_growth * (begin - 0.5);
    Passing light = Passing(1.0, 0.0, 1.0);
    for (int i = 0; i < MOST && light_of(light) > DARK; ++i) {
        if (from >= last) break;
        // A box lies straight: along a slanting way a section is not longer than the cone stays in it.
        float wide = 2.0 * tangent * (from + 0.5 + 0.5 * width) * length_mm / max(edge.y, edge.z);
        float most = min(min(width, last - from), (wide + DRIFT) / max(slant, 1e-3));
        float count = max(floor(most + 0.5), 1.0), to = from + count;
        // The section's layers, from low to below high, as far as they lie in the volume.
        int near_plane = int(at.x + float(sign_of) * from + 0.5), far_plane = int(at.x + float(sign_of) * to + 0.5);
        ivec2 along_axis = clamp(ivec2(min(near_plane, far_plane), max(near_plane, far_plane)), ivec2(0), ivec2(cells.x));
        if (along_axis.x >= along_axis.y) break;
        float middle = 0.5 * (from + to);
        vec2 center = at.yz + beside + slope * middle, half_width = tangent * middle * length_mm / edge.yz * lean;
        ivec2 low = ivec2(floor(center - half_width + 0.5)), high = ivec2(floor(center + half_width + 0.5));
        ivec2 own = ivec2(floor(center));
        low = min(low, own);
        high = max(high, own + 1);
        low = clamp(low, ivec2(0), cells.yz);
        high = clamp(high, ivec2(0), cells.yz);
        if (low.x >= high.x || low.y >= high.y) break;
        ivec3 corner = ivec3(along_axis.x, low), far_corner = ivec3(along_axis.y, high), box = far_corner - corner;
        vec4 mean = box_sum(turned_back(corner, axis), turned_back(far_corner, axis)) / float(box.x * box.y * box.z);
        // The mean counts for the section's own length.
        pass(light, mean, float(box.x) * length_mm / u_cell_mm * min(1.0, (last - from) / (to - from)), float(box.x));
        from = to;
        width *= 1.0 + u_growth;
    }
    return light_of(light);
}

#else
// The same through what is near, from the place itself to where layers meet, `stop` layers from it: narrow cones are narrower
// than a cell there, so that the cell which a cone's axis meets in each layer is its box.
float through(vec3 place, int axis, vec3 along, float tangent, float end, vec2 beside, float stop) {
    vec3 edge = turned(u_edge_mm, axis), way = turned(along, axis), at = turned(place, axis);
    float steepness = max(abs(way.x), 1e-3), length_mm = edge.x / steepness, last = end / length_mm;
    vec3 step_across = vec3(sign(way.x), way.yz / steepness * edge.x / edge.yz);
    at.yz += beside;
    Passing light = Passing(1.0, 0.0, 1.0);
    for (float from = 0.5; from < min(last, stop); from += 1.0) {
        ivec3 cell = turned_back(ivec3(floor(at + step_across * (from + 0.5))), axis);
        if (cell != clamp(cell, ivec3(0), u_cells - 1)) break;
        pass(light, texelFetch(u_matter, cell, 0), length_mm / u_cell_mm * min(1.0, last - from), 1.0);
    }
    return light_of(light);
}
#endif

// Two unit vectors across a third (Duff et al. 2017).
mat2x3 across(vec3 n) {
    float s = n.z >= 0.0 ? 1.0 : -1.0, a = -1.0 / (s + n.z), b = n.x * n.y * a;
    return mat2x3(vec3(1.0 + s * n.x * n.x * a, s * b, -s * n.x), vec3(b, s + n.y * n.y * a, -n.y));
}

// Unit vector from a place in mm to the lamp's middle, and how far it is.
vec4 way_to_lamp(vec3 p) {
    vec3 axis = u_lamp.xyz - u_lamp.w * p;
    float away = u_lamp.w > 0.0 ? max(length(axis), 1e-6 * u_cell_mm) : 1e30;
    return vec4(u_lamp.w > 0.0 ? axis / away : axis, away);
}

// Share of the light of all narrow cones that comes from a place, in cells, on one side of a bound, so many layers along an axis
// (each cone's own if it is < 0): beyond it what is far, up to it what is near; times what a lamp that shines to one side sends that way, which is all that `open` holds.
float all_through(vec3 place, vec4 way, int axis, float bound, out float open) {
    float sum = 0.0;
#if POINTS
    vec3 p = place * u_edge_mm;
    open = 0.0;
    for (int k = 0; k < CONES; ++k) {
        vec3 along = u_place[k] - p;
        float distance_mm = max(length(along), 1e-6 * u_cell_mm);
        along /= distance_mm;
        float weight = dot(u_shines, u_shines) > 0.0 ? max(dot(-along, u_shines), 0.0) : 1.0;
        if (weight <= 0.0) continue;
        open += weight / float(CONES);
        // A rectangle seen from the side is narrow, and what lies behind it is not in the way.
        float tangent = u_tangent >= 0.0 ? u_tangent : u_part * max(weight, 0.1) / distance_mm;
        int its = axis < 0 ? dominant(along) : axis;
        sum += weight / float(CONES) * through(place, its, along, tangent, distance_mm, ACROSS_A_CELL * u_disc[k], bound);
    }
#else
    open = 1.0;
    float tangent = u_tangent >= 0.0 ? u_tangent : u_radius / way.w;
    mat2x3 sides = across(way.xyz);
    for (int k = 0; k < CONES; ++k) {
        vec3 along = normalize(way.xyz + sides * (u_disc[k] * tangent));
        int its = axis < 0 ? dominant(along) : axis;
        sum += through(place, its, along, tangent * u_part, way.w, ACROSS_A_CELL * u_disc[k], bound) / float(CONES);
    }
#endif
    return sum;
}

#if PART == 2
const float ABOUT_AS_STEEP = 0.85;

int second(vec3 steep, int first) {
    int a = first == 0 ? 1 : 0, b = first == 2 ? 1 : 2;
    return steep[a] >= steep[b] ? a : b;
}

// Light that reaches a place, in cells, through what is near: up to a plane across an axis, u_split layers from the middle of its
// 2^3 cells towards the lamp; and through what is far, from where its way meets that plane. `forward` tells the way's side.
float past_plane(vec3 place, vec3 middle, vec4 way, int axis, float forward, out float open) {
    vec3 to_place = turned(place - middle, axis), slope = turned(way.xyz / u_edge_mm, axis);
    slope /= forward > 0.0 ? max(slope.x, 1e-3) : min(slope.x, -1e-3);
    float stop = float(u_split) - to_place.x * sign(forward);
    vec3 at_far = middle + turned_back(vec3(0.0, to_place.yz - slope.yz * to_place.x), axis);
    // All narrow cones: one wide one's boxes would be rounded alike in all cells, and light jump where they turn over.
    return all_through(place, way, axis, stop, open) * textureLod(u_far, at_far / vec3(u_cells), 0.0).r;
}
#endif

void main() {
    ivec3 cell = ivec3(ivec2(gl_FragCoord.xy), v_layer);
#if PART == 1
    o_light = vec2(1.0);
    // 2^3 cells; so far from where light matters that nothing is interpolated from here, it is not needed.
    vec3 place = vec3(2 * cell + 1);
    vec4 matter = box_sum(max(2 * cell - u_around, 0), min(2 * cell + 2 + u_around, u_cells));
    if (matter.r + matter.g == 0.0) return;
    float open, sum = all_through(place, way_to_lamp(place * u_edge_mm), -1, float(u_split), open);
    o_light = vec2(open > 0.0 ? sum / open : 1.0);
#else
    o_light = vec2(0.0);
    float openness = texelFetch(u_near, cell, 0).r;
    if (openness == 0.0) return;
    vec3 place = vec3(cell) + 0.5, p = place * u_edge_mm;
    vec4 way = way_to_lamp(p);

    // 1. What reaches the cell if nothing is in the way.
    float arriving = u_reach > 0.0 ? 1.0 / (1.0 + way.w * way.w / (u_reach * u_reach)) : 1.0;
    if (u_beam_edge.x < u_beam_edge.y) arriving *= smoothstep(u_beam_edge.x, u_beam_edge.y, dot(-way.xyz, u_beam));

    // 2. What is in the way, cone by cone.
#if PART == 2
    // Far begins at a plane that is the same for all 2^3 cells.
    vec3 middle = 2.0 * floor(0.5 * vec3(cell)) + 1.0;
    vec3 main_way = way_to_lamp(middle * u_edge_mm).xyz, steep = abs(main_way / u_edge_mm);
    int axis = dominant(main_way), other = second(steep, axis);
    float tie = steep[other] / steep[axis], open, sum = 0.0;
    // Where two axes are about as steep both count, so that nothing jumps when a lamp goes from one to the other. A loop, since
    // software renderers run both sides of a branch.
    float beside = 0.5 * smoothstep(ABOUT_AS_STEEP, 1.0, tie);
    for (int k = 0; k < (beside > 0.0 ? 2 : 1); ++k) {
        int its = k == 0 ? axis : other;
        sum += (k == 0 ? 1.0 - beside : beside) * past_plane(place, middle, way, its, main_way[its], open);
    }
#else
    float open, sum = all_through(place, way, -1, 0.5, open);
#endif
    o_light = openness * vec2(arriving * max(sum, u_unshadowed * open), 1.0);
#endif
}
