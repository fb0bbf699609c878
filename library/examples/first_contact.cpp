// When does a mesh first touch itself in one step, and where?
//   c++ -std=c++20 first_contact.cpp -lcscd -ltbb

#include <cscd/cscd.h>
#include <iostream>

using Rows = Eigen::Matrix<double, Eigen::Dynamic, 3, Eigen::RowMajor>;

int main() {
  // Two tetrahedra, one above the other. The upper one falls.
  Eigen::Matrix<int, Eigen::Dynamic, 3, Eigen::RowMajor> faces(8, 3);
  faces << 0, 2, 1, 0, 1, 3, 1, 2, 3, 2, 0, 3, 4, 6, 5, 4, 5, 7, 5, 6, 7, 6, 4, 7;
  Rows before(8, 3);
  before << 0, 0, 0, 1, 0, 0, 0, 1, 0, 0.3, 0.3, 1,  // the lower one
      0, 0, 2, 1, 0, 2, 0, 1, 2, 0.3, 0.3, 3;        // the upper one
  Rows after = before;
  after.bottomRows(4).col(2).array() -= 2;

  cscd::SelfCollision body(faces, before);
  const cscd::SelfCollision::Answer answer = body.first_contact(before, after);
  for (const auto& contact : answer.contacts)
    std::cout << (contact.edges ? "edges " : "vertex and face ") << contact.vertices[0] << ' '
              << contact.vertices[1] << ' ' << contact.vertices[2] << ' ' << contact.vertices[3]
              << " touch at t = " << contact.time << " in " << contact.point.transpose() << '\n';
  std::cout << "the step may go to t = " << body.largest_step(before, after) << '\n';
  return answer.free() ? 1 : 0;
}
