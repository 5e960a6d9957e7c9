// SPDX-License-Identifier: MIT OR Apache-2.0
// Part of the SpTFRA hardware generator.
//
// Results to taxels: the four parity components of an orbit become the values of its four taxels. u_0 gets the stress
// added first. Where taxels are not folded, results pass as they are.
//
// Result bus to taxels: 5 cycles, one orbit a cycle; 1 where taxels are not folded. The formats leave room: a taxel's
// value has DATA_BITS bits at a quarter of the components' step. Image 0 is the orbit's taxel next to the origin, 1 its
// mirror image in x, 2 in y, 3 in both.

`default_nettype none

module sptfra_unfold #(
    // 4: parity components; 1: taxels
    parameter CHANNELS = 4,
    // Elements of a vector: taxels, or orbits of a folded grid
    parameter ELEMENTS = 25,
    // Bits of a value
    parameter DATA_BITS = 27,
    // Exponent of the step of u over that of the folded stress
    parameter U_SHIFT = 2,
    // Derived
    parameter ROW_WIDTH = (ELEMENTS > 8) ? $clog2(ELEMENTS) : 3
) (
    input  wire clock,
    input  wire reset,
    // The folded stress, as it is written to the operand memories
    input  wire stress_write,
    input  wire stress_write_bank,
    input  wire [ROW_WIDTH-1:0] stress_write_row,
    input  wire [CHANNELS*DATA_BITS-1:0] stress_write_data,
    // Result bus: y, u0, u1, u2 and, of a folded field, A_p r
    input  wire result_y,
    input  wire [2:0] result_u,
    input  wire [2:0] result_force,
    input  wire [ROW_WIDTH-1:0] result_row,
    input  wire [CHANNELS*DATA_BITS-1:0] result_value,
    input  wire result_last,
    // Taxels, image 0 in the lowest bits
    output wire taxel_y,
    output wire [2:0] taxel_u,
    output wire [2:0] taxel_force,
    output wire [ROW_WIDTH-1:0] taxel_row,
    output wire [CHANNELS*DATA_BITS-1:0] taxels,
    output wire taxel_last, // of its program
    output reg  coefficients_complete // one cycle, with the last u: the stress of this frame is done with
);

    // ---- What a value is, beside it on its way: stage k holds what was on the bus k cycles ago
    localparam LATENCY = (CHANNELS == 4) ? 5 : 1; // from the result bus to taxels, which simulations check
    localparam STAGES = (CHANNELS == 4) ? 5 : 1;

    wire [6:0] route = {result_force, result_u, result_y};
    wire routed = (route != 7'd0);
    reg [7*STAGES-1:0] routes;
    reg [STAGES-1:0] lasts;
    reg [ROW_WIDTH*STAGES-1:0] rows;
    wire [7*STAGES+6:0] next_routes = {routes, route};
    wire [STAGES:0] next_lasts = {lasts, routed && result_last};
    wire [ROW_WIDTH*(STAGES+1)-1:0] next_rows = {rows, result_row};
    // In the cycle before the taxels: the last u of a program is that of the frame
    wire last_u = next_lasts[STAGES-1] && (next_routes[7*(STAGES-1)+1 +: 3] != 3'd0);

    assign {taxel_force, taxel_u, taxel_y} = routes[7*(STAGES-1) +: 7];
    assign taxel_last = lasts[STAGES-1];
    assign taxel_row = rows[ROW_WIDTH*(STAGES-1) +: ROW_WIDTH];

    always @(posedge clock) begin
        routes <= next_routes[7*STAGES-1:0];
        lasts <= next_lasts[STAGES-1:0];
        rows <= next_rows[ROW_WIDTH*STAGES-1:0];
        coefficients_complete <= last_u;
        if (reset) begin
            routes <= {(7*STAGES){1'b0}};
            lasts <= {STAGES{1'b0}};
            coefficients_complete <= 1'b0;
        end
    end

    wire _unused_pipe = &{1'b0, next_routes, next_lasts, next_rows};

    sptfra_check_latency #(
        .CYCLES    (LATENCY),
        .PIPELINED (1)
    ) check_latency (
        .clock (clock),
        .reset (reset),
        .start (routed),
        .done  (routes[7*(STAGES-1) +: 7] != 7'd0)
    );

    if (CHANNELS == 4) begin : gen_components
        // ---- Stage 1: the stress of the orbit. The bank changes when a frame's last u has passed
        reg bank;
        reg [4*DATA_BITS-1:0] value_1;
        wire [4*DATA_BITS-1:0] stress_1;
        wire is_u0_1 = routes[1];

        sptfra_ram #(
            .WIDTH         (4 * DATA_BITS),
            .DEPTH         (2 << ROW_WIDTH),
            .ADDRESS_WIDTH (ROW_WIDTH + 1)
        ) stress (
            .clock         (clock),
            .write_enable  (stress_write),
            .write_address ({stress_write_bank, stress_write_row}),
            .write_data    (stress_write_data),
            .read_enable   (1'b1),
            .read_address  ({bank, result_row}),
            .read_data     (stress_1)
        );

        always @(posedge clock) begin
            value_1 <= result_value;
            if (last_u) begin
                bank <= !bank;
            end
            if (reset) begin
                bank <= 1'b0;
            end
        end

        // ---- Stages 2 and 3: the stress at the step of u, added. Stages 4 and 5: mirror in x, mirror in y
        wire [4*DATA_BITS-1:0] component_3;
        genvar index;

        for (index = 0; index < 4; index = index + 1) begin : gen_component
            localparam DROP = (U_SHIFT > 0) ? U_SHIFT : 0;
            localparam RISE = (U_SHIFT < 0) ? -U_SHIFT : 0;
            wire signed [DATA_BITS-1:0] own_stress = stress_1[DATA_BITS*index +: DATA_BITS];
            wire signed [DATA_BITS-1:0] scaled = (own_stress >>> DROP) <<< RISE;
            wire half = (U_SHIFT > 0) && own_stress[(U_SHIFT > 0) ? U_SHIFT - 1 : 0];
            reg signed [DATA_BITS-1:0] addend_2;
            reg half_2;
            reg signed [DATA_BITS-1:0] value_2;
            reg signed [DATA_BITS-1:0] value_3;
            // The rounding comes in as a carry: no adder stands right behind the memory
            wire [DATA_BITS:0] sum = {value_2, 1'b1} + {addend_2, half_2};
            wire _unused_carry = &{1'b0, sum[0]};

            always @(posedge clock) begin
                addend_2 <= is_u0_1 ? scaled : {DATA_BITS{1'b0}};
                half_2 <= is_u0_1 && half;
                value_2 <= value_1[DATA_BITS*index +: DATA_BITS];
                value_3 <= sum[DATA_BITS:1];
            end

            assign component_3[DATA_BITS*index +: DATA_BITS] = value_3;
        end

        // The bits above are copies of the sign
        wire [4*DATA_BITS+7:0] wide;

        sptfra_butterfly #(
            .WIDTH (DATA_BITS)
        ) butterfly (
            .clock  (clock),
            .enable (1'b1),
            .values (component_3),
            .sums   (wide)
        );

        for (index = 0; index < 4; index = index + 1) begin : gen_images
            assign taxels[DATA_BITS*index +: DATA_BITS] = wide[(DATA_BITS+2)*index +: DATA_BITS];
        end

        wire _unused = &{1'b0, wide};
    end else begin : gen_taxels
        reg [CHANNELS*DATA_BITS-1:0] value_1;

        assign taxels = value_1;

        always @(posedge clock) begin
            value_1 <= result_value;
        end

        wire _unused = &{1'b0, stress_write, stress_write_bank, stress_write_row, stress_write_data};
    end

endmodule

`default_nettype wire
