// SPDX-License-Identifier: MIT
// A scene in Bullet (Coumans, bulletphysics.org), set up as its own demos do: btDbvtBroadphase,
// btDefaultCollisionConfiguration, btSequentialImpulseConstraintSolver with its default settings (10 iterations, warm
// start, split impulse), one shape for all bodies of a size, collision margins left at their default.
// docs/benchmark.md says how the two engines are made alike.
#include "bench/peer.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

#include <btBulletDynamicsCommon.h>

namespace talus::bench {
namespace {

btVector3 to_bullet(Vec3 v) {
    return {v.x, v.y, v.z};
}

Vec3 from_bullet(const btVector3& v) {
    return {v.x(), v.y(), v.z()};
}

btTransform to_bullet(const Pose& pose) {
    const auto& [x, y, z, w] = pose.rotation;
    return btTransform(btQuaternion(x, y, z, w), to_bullet(pose.position));
}

float combine(float a, float b, Combine rule) {
    switch (rule) {
    case Combine::Average:
        return 0.5f * (a + b);
    case Combine::Minimum:
        return std::min(a, b);
    case Combine::Maximum:
        return std::max(a, b);
    case Combine::Multiply:
        break;
    }
    return a * b;
}

const Material& material_of(const btCollisionObject* object) {
    return *static_cast<const Material*>(object->getUserPointer());
}

btScalar combine_frictions(const btCollisionObject* a, const btCollisionObject* b) {
    const Material &of_a = material_of(a), &of_b = material_of(b);
    return combine(of_a.friction, of_b.friction, std::min(of_a.friction_combine, of_b.friction_combine));
}

btScalar combine_restitutions(const btCollisionObject* a, const btCollisionObject* b) {
    const Material &of_a = material_of(a), &of_b = material_of(b);
    return combine(of_a.restitution, of_b.restitution, std::min(of_a.restitution_combine, of_b.restitution_combine));
}

/// Bullet's damping is the share of the velocity that is lost in a second.
btScalar share_lost(float damping) {
    return 1.0f - std::exp(-damping);
}

float gravity_scale(const BodyDefinition& body) {
    return body.gravity_scale.value_or(body.kind == BodyKind::Rigid ? 1.0f : 0.0f);
}

class Bullet final : public Peer {
public:
    Bullet(const scenes::Scene& scene, const Settings& settings, std::span<const cli::BodySample> start)
        : gravity(to_bullet(settings.gravity)), dt(settings.dt), bodies_at_start(start.begin(), start.end()) {
        gCalculateCombinedFrictionCallback = combine_frictions;
        gCalculateCombinedRestitutionCallback = combine_restitutions;
        world.setGravity(gravity);
        bodies.reserve(scene.bodies.size());
        for (std::size_t i = 0; i < scene.bodies.size(); ++i)
            add(scene.bodies[i].definition, start[i]);
    }

    ~Bullet() override {
        for (const Body& body : bodies)
            world.removeRigidBody(body.rigid.get());
    }

    void step() override {
        for (const Body& body : bodies)
            if (body.rigid->isKinematicObject()) move_kinematic(*body.rigid, body.gravity_scale);
        world.stepSimulation(dt, 0); // 0: one step of this length, without sub-steps
    }

    PeerDescription description() const override {
        const int version = btGetVersion(); // 324 for 3.24
        return {"Bullet", std::to_string(version / 100) + "." + std::to_string(version % 100), 1,
                static_cast<std::uint32_t>(world.getSolverInfo().m_numIterations)};
    }

    PeerCounts counts() const override {
        PeerCounts counts;
        counts.pairs = static_cast<std::uint32_t>(world.getPairCache()->getNumOverlappingPairs());
        for (int i = 0; i < dispatcher.getNumManifolds(); ++i) {
            const int points = dispatcher.getManifoldByIndexInternal(i)->getNumContacts();
            if (points > 0) ++counts.manifolds;
            counts.contacts += static_cast<std::uint32_t>(points);
        }
        return counts;
    }

    std::vector<cli::BodySample> samples() const override {
        std::vector<cli::BodySample> samples = bodies_at_start;
        for (std::size_t i = 0; i < bodies.size(); ++i) {
            const btRigidBody& body = *bodies[i].rigid;
            const btTransform& transform = body.getWorldTransform();
            const btQuaternion rotation = transform.getRotation();
            samples[i].pose = {from_bullet(transform.getOrigin()),
                               {rotation.x(), rotation.y(), rotation.z(), rotation.w()}};
            samples[i].velocity = {from_bullet(body.getLinearVelocity()), from_bullet(body.getAngularVelocity())};
        }
        return samples;
    }

private:
    struct Body {
        std::unique_ptr<btMotionState> motion; ///< of a kinematic body: where it is to be after the step
        std::unique_ptr<btRigidBody> rigid;
        float gravity_scale = 1.0f;
    };

    void add(const BodyDefinition& definition, const cli::BodySample& start) {
        const bool dynamic = definition.kind == BodyKind::Rigid;
        Body& body = bodies.emplace_back();
        body.gravity_scale = gravity_scale(definition);
        if (definition.kind == BodyKind::Kinematic)
            body.motion = std::make_unique<btDefaultMotionState>(to_bullet(start.pose));
        btRigidBody::btRigidBodyConstructionInfo info(dynamic ? start.mass : 0.0f, body.motion.get(),
                                                      shape_of(definition.shape),
                                                      dynamic ? to_bullet(start.inertia) : btVector3(0, 0, 0));
        info.m_startWorldTransform = to_bullet(start.pose);
        body.rigid = std::make_unique<btRigidBody>(info);
        btRigidBody& rigid = *body.rigid;
        // Bullet only reads it.
        rigid.setUserPointer(const_cast<Material*>(&definition.material));
        rigid.setDamping(share_lost(definition.linear_damping), share_lost(definition.angular_damping));
        rigid.setLinearVelocity(to_bullet(start.velocity.linear));
        rigid.setAngularVelocity(to_bullet(start.velocity.angular));
        if (definition.kind == BodyKind::Kinematic)
            rigid.setCollisionFlags(rigid.getCollisionFlags() | btCollisionObject::CF_KINEMATIC_OBJECT);
        rigid.setActivationState(DISABLE_DEACTIVATION); // nothing sleeps
        world.addRigidBody(&rigid);
        if (dynamic) rigid.setGravity(body.gravity_scale * gravity);
    }

    btCollisionShape* shape_of(const Shape& shape) {
        std::array<float, 4> key{};
        if (const Box* box = std::get_if<Box>(&shape)) {
            key = {0.0f, box->size.x, box->size.y, box->size.z};
        } else {
            key = {1.0f, std::get<Sphere>(shape).radius, 0.0f, 0.0f};
        }
        std::unique_ptr<btCollisionShape>& known = shapes[key];
        if (!known && key[0] == 0.0f) known = std::make_unique<btBoxShape>(0.5f * btVector3(key[1], key[2], key[3]));
        if (!known) known = std::make_unique<btSphereShape>(key[1]);
        return known.get();
    }

    /// Bullet derives a kinematic body's velocity from where its motion state is at the next step.
    void move_kinematic(btRigidBody& body, float scale) {
        const btVector3 velocity = body.getLinearVelocity() + scale * dt * gravity;
        btTransform next;
        btTransformUtil::integrateTransform(body.getWorldTransform(), velocity, body.getAngularVelocity(), dt, next);
        body.getMotionState()->setWorldTransform(next);
    }

    btDefaultCollisionConfiguration configuration;
    btCollisionDispatcher dispatcher{&configuration};
    btDbvtBroadphase broad_phase;
    btSequentialImpulseConstraintSolver solver;
    mutable btDiscreteDynamicsWorld world{&dispatcher, &broad_phase, &solver,
                                          &configuration}; // its getters are not const
    btVector3 gravity;
    float dt;
    std::map<std::array<float, 4>, std::unique_ptr<btCollisionShape>> shapes;
    std::vector<cli::BodySample> bodies_at_start;
    std::vector<Body> bodies;
};

} // namespace

void require_bullet() {}

std::unique_ptr<Peer> make_bullet(const scenes::Scene& scene, const Settings& settings,
                                  std::span<const cli::BodySample> start) {
    return std::make_unique<Bullet>(scene, settings, start);
}

} // namespace talus::bench
