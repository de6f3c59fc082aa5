// One rule makes every machine: an elastic body adds its compliance to every pair of contacts that
// share it, with a plus when both see it from the same side (tool or work), with a minus when one
// has it on the tool's side and the other on the work's. With r = A − O, at the point A_k for a
// unit force at A_l:
//
//   G(k, l) = e + c [r_l] − [r_k] cᵀ − [r_k] ξ [r_l],      E_kl = Σ s_b(k) s_b(l) G_b(k, l)
//
// (a force at A_l has the moment r_l × f about the base point O; O moves by e f + c m, the body
// turns by θ = cᵀ f + ξ m, and a point at r moves by θ × r = −[r] θ more).
//
// respond() gives the same without E: each joint carries the sum of what hangs on it, and each body
// moves with the sum of the joints under it. Bodies on both sides of a contact carry +F and −F.
#include "accuracy/structure.h"

#include <algorithm>
#include <cassert>

namespace aircut::accuracy {
namespace {

Mat6 beam_influence(const Beam& beam, const Vec3& at, const Vec3& load_at) {
  const Vec3& u = beam.axis;
  const auto place = [&](const Vec3& p) {
    return std::clamp(u.dot(p - beam.clamp), 0.0, beam.length());
  };
  const BeamInfluence g = influence(beam, place(at), place(load_at));
  // Bending goes across the axis. A slope δ' turns the section by u × δ'; a moment M bends as the
  // couple M × u does.
  const Mat3 across = Mat3::Identity() - u * u.transpose();
  const Mat3 turn = skew(u);
  Mat6 out;
  out << g.deflection * across, -g.load_slope * turn, g.slope * turn, g.cross_slope * across;
  return out;
}

}  // namespace

Mat3 skew(const Vec3& r) {
  Mat3 out;
  out << 0, -r.z(), r.y(), r.z(), 0, -r.x(), -r.y(), r.x(), 0;
  return out;
}

Mat6 body_influence(const Body& body, const Vec3& at, const Vec3& load_at) {
  if (body.beam) return beam_influence(*body.beam, at, load_at);
  const Compliance& C = body.compliance;
  const Mat3 reader = skew(at - body.base_point), arm = skew(load_at - body.base_point);
  const Mat3 turn_by_force = C.c.transpose() + C.xi * arm;
  Mat6 out;
  out << C.e + C.c * arm - reader * turn_by_force, C.c - reader * C.xi, turn_by_force, C.xi;
  return out;
}

std::vector<int> parents_first(std::span<const int> parents) {
  std::vector<std::vector<int>> children(parents.size());
  std::vector<int> order;
  for (std::size_t i = 0; i < parents.size(); ++i) {
    if (parents[i] == ground)
      order.push_back(static_cast<int>(i));
    else
      children[static_cast<std::size_t>(parents[i])].push_back(static_cast<int>(i));
  }
  for (std::size_t i = 0; i < order.size(); ++i) {
    const auto& next = children[static_cast<std::size_t>(order[i])];
    order.insert(order.end(), next.begin(), next.end());
  }
  return order;
}

std::vector<Response> Influence::responses(std::span<const Load> loads) const {
  assert(loads.size() == n_ && "one load per contact");
  std::vector<Response> out(n_);
  for (std::size_t k = 0; k < n_; ++k)
    for (std::size_t l = 0; l < n_; ++l) {
      const Mat6& B = block(k, l);
      out[k].displacement +=
          B.topLeftCorner<3, 3>() * loads[l].force + B.topRightCorner<3, 3>() * loads[l].moment;
      out[k].rotation += B.bottomLeftCorner<3, 3>() * loads[l].force +
                         B.bottomRightCorner<3, 3>() * loads[l].moment;
    }
  return out;
}

Structure::Structure(std::vector<Body> bodies) : bodies_(std::move(bodies)) {
  std::vector<int> parents;
  for (const Body& body : bodies_) {
    parents.push_back(body.parent);
    has_beams_ = has_beams_ || body.beam;
  }
  order_ = parents_first(parents);
  assert(order_.size() == bodies_.size() && "the bodies must form a forest");
}

std::vector<int> Structure::signs(const Contact& contact) const {
  std::vector<int> out(bodies_.size(), 0);
  const auto walk = [&](int body, int sign) {
    for (; body != ground; body = bodies_[static_cast<std::size_t>(body)].parent)
      out[static_cast<std::size_t>(body)] += sign;
  };
  walk(contact.tool_body, 1);
  walk(contact.work_body, -1);
  return out;
}

Influence Structure::assemble(std::span<const Contact> contacts) const {
  Influence out(contacts.size());
  std::vector<std::vector<int>> sides;
  for (const Contact& contact : contacts) sides.push_back(signs(contact));
  for (std::size_t k = 0; k < contacts.size(); ++k)
    for (std::size_t l = 0; l < contacts.size(); ++l)
      for (std::size_t b = 0; b < bodies_.size(); ++b)
        if (const int sign = sides[k][b] * sides[l][b]; sign != 0)
          out.block(k, l) +=
              sign * body_influence(bodies_[b], contacts[k].point, contacts[l].point);
  return out;
}

void Structure::respond(std::span<const Contact> contacts, std::span<const Load> loads,
                        Scratch& scratch, std::span<Response> out) const {
  assert(loads.size() == contacts.size() && out.size() == contacts.size());
  scratch.loads.assign(bodies_.size(), Load{});
  scratch.motion.resize(bodies_.size());
  const auto put = [&](int body, const Vec3& force, const Vec3& moment) {
    if (body == ground) return;
    Load& load = scratch.loads[static_cast<std::size_t>(body)];
    load.force += force;
    load.moment += moment;
  };
  for (std::size_t k = 0; k < contacts.size(); ++k) {
    const Vec3& force = loads[k].force;
    const Vec3 moment = loads[k].moment + contacts[k].point.cross(force);
    put(contacts[k].tool_body, force, moment);
    put(contacts[k].work_body, -force, -moment);
  }
  for (auto it = order_.rbegin(); it != order_.rend(); ++it) {
    const Load& load = scratch.loads[static_cast<std::size_t>(*it)];
    put(bodies_[static_cast<std::size_t>(*it)].parent, load.force, load.moment);
  }
  for (const int index : order_) {
    const Body& body = bodies_[static_cast<std::size_t>(index)];
    Response& motion = scratch.motion[static_cast<std::size_t>(index)];
    motion =
        body.parent == ground ? Response{} : scratch.motion[static_cast<std::size_t>(body.parent)];
    if (body.beam) continue;  // bends between its contacts: add_beams()
    const Load& load = scratch.loads[static_cast<std::size_t>(index)];
    const Compliance& C = body.compliance;
    const Vec3 moment = load.moment - body.base_point.cross(load.force);
    const Vec3 turn = C.c.transpose() * load.force + C.xi * moment;
    motion.rotation += turn;
    motion.displacement += C.e * load.force + C.c * moment - turn.cross(body.base_point);
  }
  const auto moved = [&](int body, const Vec3& point) {
    if (body == ground) return Response{};
    const Response& m = scratch.motion[static_cast<std::size_t>(body)];
    return Response{m.displacement + m.rotation.cross(point), m.rotation};
  };
  for (std::size_t k = 0; k < contacts.size(); ++k) {
    const Response tool = moved(contacts[k].tool_body, contacts[k].point);
    const Response work = moved(contacts[k].work_body, contacts[k].point);
    out[k] = {tool.displacement - work.displacement, tool.rotation - work.rotation};
  }
  if (has_beams_) add_beams(contacts, loads, out);
}

void Structure::add_beams(std::span<const Contact> contacts, std::span<const Load> loads,
                          std::span<Response> out) const {
  const auto side = [&](const Contact& contact, int body) {
    return (contact.tool_body == body ? 1 : 0) - (contact.work_body == body ? 1 : 0);
  };
  for (std::size_t b = 0; b < bodies_.size(); ++b) {
    if (!bodies_[b].beam) continue;
    const int body = static_cast<int>(b);
    for (std::size_t k = 0; k < contacts.size(); ++k)
      for (std::size_t l = 0; l < contacts.size(); ++l) {
        const int sign = side(contacts[k], body) * side(contacts[l], body);
        if (sign == 0) continue;
        const Mat6 B = sign * body_influence(bodies_[b], contacts[k].point, contacts[l].point);
        out[k].displacement +=
            B.topLeftCorner<3, 3>() * loads[l].force + B.topRightCorner<3, 3>() * loads[l].moment;
        out[k].rotation += B.bottomLeftCorner<3, 3>() * loads[l].force +
                           B.bottomRightCorner<3, 3>() * loads[l].moment;
      }
  }
}

}  // namespace aircut::accuracy
